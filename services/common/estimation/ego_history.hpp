// The recent motion of the vehicle, for the motion at a scan's time of measurement instead of its time of arrival.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/ego_motion.hpp"

namespace boresight {

/// Motion at one instant; speed as signalled (without k_v).
struct EgoSample {
  bool valid = false;  ///< speed and yaw rate are known
  bool stale = false;  ///< no message within the limit; the values are those of the nearest message
  double speed_mps = 0.0;
  double speed_std_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double yaw_rate_std_radps = 0.0;
};

/// Ring of the last 128 ego motions, ordered by measurement time. No allocation.
class EgoHistory {
 public:
  /// `max_age_ns`: largest distance to the nearest message of a sample that is not stale.
  explicit EgoHistory(std::int64_t max_age_ns = 200'000'000) : max_age_ns_(max_age_ns) {}

  /// Ignores messages without speed and yaw rate, with values that are not finite, and messages up to a second older
  /// than the newest one. A jump back by more than a second empties the ring, as when a recording starts again.
  void add(const EgoMotion& motion);

  /// Linear between two messages; the nearest message's values before the first and after the last one.
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
