// Keeps the learnt levels of the radars over restarts: restores them before the first report, and writes them while
// they are learnt.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "services/common/runtime/node.hpp"
#include "services/common/runtime/state_writer.hpp"
#include "services/health/config.hpp"
#include "services/health/core/function/levels_codec.hpp"
#include "services/health/core/supervision.hpp"

namespace boresight::health {

class LevelStore {
 public:
  /// Restores the levels. A file that cannot be used is a fault of the node and the event `levels_lost`.
  LevelStore(runtime::Node& node, Supervision& supervision, const VehicleConfig& vehicle, const FileConfig& config);
  /// Writes if the time has come and something was learnt since.
  void keep(std::int64_t now_ns);
  /// Writes the last levels; call it after the node has stopped.
  void finish();

 private:
  void restore(const std::filesystem::path& file);
  void lose(const std::filesystem::path& file, const std::string& reason, Fault fault);
  /// The levels as bytes. Valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> encoded(const VehicleLevels& levels);
  void set_kept(std::span<const std::uint8_t> bytes);

  runtime::Node& node_;
  Supervision& supervision_;
  LevelsIdentity identity_;
  std::int64_t wait_ns_;  ///< to the next write
  std::int64_t period_ns_;
  std::array<std::uint8_t, kMaxLevelsBytes + 1> bytes_{};
  std::array<std::uint8_t, kMaxLevelsBytes> kept_{};  // the bytes that were restored, or offered last
  std::size_t kept_size_ = 0;
  std::int64_t next_ns_ = 0;
  std::uint64_t reported_failures_ = 0;
  std::unique_ptr<runtime::StateWriter> writer_;  // none: nothing is stored
};

}  // namespace boresight::health
