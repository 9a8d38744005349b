// Clock of the driving time: blocks of one length, numbered, without the pauses between them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "interfaces/messages/header.hpp"

namespace boresight::alignment::batch {

/// The same scans give the same numbers in every pass over a recording.
class DrivingClock {
 public:
  explicit DrivingClock(double block_s) : block_s_(block_s) {}

  /// Number of the block of a usable scan. A clock that jumps back begins a new block.
  std::size_t block_at(std::int64_t time_ns) {
    constexpr double kLatest_s = 0.5;  // of scans that arrive out of order
    const double since_s = 1e-9 * static_cast<double>(time_ns - start_ns_);
    if (blocks_ == 0 || since_s >= block_s_ || since_s < -kLatest_s) {
      start_ns_ = time_ns;
      ++blocks_;
    }
    return blocks_ - 1;
  }
  [[nodiscard]] std::size_t blocks() const { return blocks_; }
  [[nodiscard]] double driven_s() const { return block_s_ * static_cast<double>(blocks_); }

 private:
  double block_s_;
  std::int64_t start_ns_ = 0;
  std::size_t blocks_ = 0;
};

}  // namespace boresight::alignment::batch
