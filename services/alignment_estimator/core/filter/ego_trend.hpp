// Acceleration of the vehicle, and extrapolation of its motion between ego messages. A scan that arrives before the
// next message has only the values of the last one, which are old by then.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/alignment_estimator/core/filter/scan_motion.hpp"
#include "services/common/estimation/ego_history.hpp"

namespace boresight::alignment {

class EgoTrend {
 public:
  /// The motion at the time of a scan. A straight line through the last 0.4 s gives the rates of speed and yaw rate.
  /// Values that are bit-identical to earlier ones are extrapolated along it.
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
