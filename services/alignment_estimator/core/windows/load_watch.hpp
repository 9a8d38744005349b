// Change of the load: a step of the pitch that all radars share. It is allowed at every stop, and where the common
// pitch of some blocks stands out; the solution with the step decides a while later whether there was one.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "services/alignment_estimator/core/windows/change_monitor.hpp"

namespace boresight::alignment::windows {

struct LoadConfig {
  double least_rad = 0.00436;    ///< smallest change that is reported, 0.25°
  double stds = 3.0;             ///< and in its own std
  double watch_s = 14.0;         ///< driving time until the decision
  double scatter_rad = 0.00175;  ///< of the means of the common pitch before any block, 0.1°
  double scatter_factor = 4.0;   ///< a mean that stands out is larger than their scatter by this
  double settle_s = 25.0;        ///< driving time before the first step is allowed
};

struct LoadVerdict {
  bool suspect = false;     ///< the blocks must not be learnt from
  bool stands_out = false;  ///< for kBlocks blocks
};

class LoadWatch {
 public:
  static constexpr std::size_t kBlocks = 8;
  explicit LoadWatch(const LoadConfig& config) : config_(config) {}

  /// Judges the latest block of every radar.
  [[nodiscard]] LoadVerdict judge(const std::vector<Deviation2>& deviations);
  /// A step was allowed or decided: earlier blocks are void.
  void restart() { size_ = large_ = 0; }

 private:
  static constexpr std::size_t kHistory = 150;
  LoadConfig config_;
  std::array<double, kBlocks> latest_{};  ///< common pitch of the latest blocks
  std::size_t size_ = 0, next_ = 0, large_ = 0;
  std::array<double, kHistory> history_{};  ///< of the means of kBlocks blocks, their size
  std::size_t history_size_ = 0, history_next_ = 0;
};

}  // namespace boresight::alignment::windows
