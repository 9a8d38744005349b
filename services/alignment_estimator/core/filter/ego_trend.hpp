// Acceleration of the vehicle, and its motion between messages of the ego sensors: a scan that arrives before the next
// message is given the last one's values, which by then are old.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/alignment_estimator/core/filter/motion_model.hpp"
#include "services/common/estimation/ego_history.hpp"

namespace boresight::alignment {

class EgoTrend {
 public:
  /// The motion at the time of a scan, with the rates of speed and yaw rate by a straight line through the last 0.4 s;
  /// values that are repeated to the last bit at a later time are taken on along it.
  [[nodiscard]] ScanMotion3d at(std::int64_t time_ns, const EgoSample& ego);

 private:
  struct Entry {
    std::int64_t time_ns;
    double speed_mps, yaw_rate_radps;
  };
  void fit();
  [[nodiscard]] const Entry& newest(std::size_t back) const {
    return ring_[(next_ + ring_.size() - 1 - back) % ring_.size()];
  }
  std::array<Entry, 32> ring_{};
  std::size_t next_ = 0, size_ = 0;
  double acceleration_mps2_ = 0.0, yaw_acceleration_radps2_ = 0.0;
};

}  // namespace boresight::alignment
