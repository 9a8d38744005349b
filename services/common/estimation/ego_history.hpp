// The recent motion of the vehicle, so that a scan meets the motion of its own time and not of its arrival.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/ego_motion.hpp"

namespace boresight {

/// Motion at one instant; speed as signalled (without k_v).
struct EgoSample {
  bool valid = false;  ///< speed and yaw rate are known
  bool stale = false;  ///< nothing newer than the limit; the values are the nearest known
  double speed_mps = 0.0;
  double speed_std_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double yaw_rate_std_radps = 0.0;
};

/// Ring of the last 128 ego motions, ordered by measurement time. No allocation.
class EgoHistory {
 public:
  /// `max_age_ns`: how far from the nearest message an instant may be before the sample is stale.
  explicit EgoHistory(std::int64_t max_age_ns = 200'000'000) : max_age_ns_(max_age_ns) {}

  /// Ignores messages without speed and yaw rate, with values that are not finite, and those that are not newer than
  /// the newest by up to a second; a jump back by more empties the ring (a recording that started again).
  void add(const EgoMotion& motion);

  /// Linear between two messages, held before the first and after the last one.
  [[nodiscard]] EgoSample at(std::int64_t time_ns) const;

 private:
  struct Entry {
    std::int64_t time_ns;
    double speed_mps, speed_std_mps, yaw_rate_radps, yaw_rate_std_radps;
  };
  [[nodiscard]] const Entry& newest(std::size_t back) const {
    return ring_[(next_ + ring_.size() - 1 - back) % ring_.size()];
  }
  std::int64_t max_age_ns_;
  std::array<Entry, 128> ring_{};
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace boresight
