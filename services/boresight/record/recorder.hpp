// Several captures at the same time: one candump log for all CAN interfaces, one pcap file for each network interface.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "services/boresight/record/can_capture.hpp"
#include "services/boresight/record/capture_plan.hpp"
#include "services/boresight/record/packet_capture.hpp"
#include "services/common/recording/writer.hpp"

namespace boresight::record {

/// Names the files of a plan: `out` itself, if it has the extension of the single file (.log, .pcap), else files in the
/// folder `out`, which is made. Throws CaptureError if one of them exists already, and std::invalid_argument if
/// `out` does not fit the plan.
struct OutputFiles {
  std::filesystem::path can;                   ///< empty if no CAN is recorded
  std::vector<std::filesystem::path> packets;  ///< as plan.packets
};
[[nodiscard]] OutputFiles name_files(const CapturePlan& plan, const std::filesystem::path& out,
                                     const std::string& date_and_time);

struct Totals {
  std::uint64_t frames = 0;  ///< CAN frames and packets
  std::uint64_t bytes = 0;   ///< of the files
  std::uint64_t dropped = 0;
};

struct FileSummary {
  std::string file;
  std::string what;  ///< "can can0, can1" or "eth0"
  Totals totals;
};

class Recorder {
 public:
  /// Called when an interface is lost. Recording goes on with the others, and with this one when it is back.
  using OnProblem = std::function<void(const std::string&)>;

  /// Opens every interface, then every file. Throws CaptureError, recording::WriteError, and std::invalid_argument for
  /// a filter or an `out` that is wrong.
  Recorder(const CapturePlan& plan, const std::filesystem::path& out, const std::string& date_and_time,
           OnProblem on_problem);

  /// Waits up to `timeout_ms` for input and writes it. Throws recording::WriteError.
  void turn(int timeout_ms);
  /// To be called each second: flushes the files and tries lost interfaces again.
  void each_second();

  [[nodiscard]] std::vector<FileSummary> summaries() const;
  [[nodiscard]] Totals totals() const;
  [[nodiscard]] std::uint64_t interruptions() const { return interruptions_; }

 private:
  void tell(const std::string& problem);

  OnProblem on_problem_;
  std::vector<std::unique_ptr<CanCapture>> can_;
  std::vector<std::unique_ptr<PacketCapture>> packets_;
  std::unique_ptr<recording::CandumpWriter> can_writer_;
  std::vector<std::unique_ptr<recording::PcapWriter>> packet_writers_;
  std::uint64_t interruptions_ = 0;
};

}  // namespace boresight::record
