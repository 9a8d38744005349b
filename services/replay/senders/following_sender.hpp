// For --speed max: holds frames back until the pipeline has published the track lists of earlier scans.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "services/common/runtime/node.hpp"
#include "services/replay/config.hpp"
#include "services/replay/core/input_losses.hpp"
#include "services/replay/core/scan_window.hpp"
#include "services/replay/senders/sender.hpp"

namespace boresight::replay {

class FollowingSender : public Sender {
 public:
  /// Joins the bus and reads it from now on. RouDi must be reachable.
  FollowingSender(std::unique_ptr<Sender> receiver, const MaxSpeedConfig& config);

  bool send(const recording::Frame& frame) override;
  void wait_until(std::int64_t due_ns) override { receiver_->wait_until(due_ns); }
  void end_recording() override { receiver_->end_recording(); }

  /// Ends the connection, so that the receiver completes its last scans; waits for these and for the last heartbeats.
  void finish();
  /// Whether a scan did not come back as a track list, or a service lost inputs.
  [[nodiscard]] bool has_losses() const;
  /// One line for each radar, and for each service that lost inputs.
  [[nodiscard]] std::string text() const;

 private:
  void wait_for_reading();
  void wait_for_room();
  void serve();

  std::unique_ptr<Sender> receiver_;
  runtime::Node node_;
  ScanWindow window_;
  InputLosses input_losses_;
};

}  // namespace boresight::replay
