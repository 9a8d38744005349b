// Which directions of a scan hold detections, so that what is expected elsewhere need not be worked out.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace boresight::ghosts {

class Directions {
 public:
  void clear() { bits_ = 0; }
  void add(double azimuth_rad) { bits_ |= bit(sector(azimuth_rad)); }
  /// Whether a detection may be within `half_width_m` of a place, given from the sensor; true also if that is so by the
  /// width of the sectors only.
  [[nodiscard]] bool may_hold(const Eigen::Vector2d& place_m, double half_width_m) const {
    const double range_m = place_m.norm();
    if (range_m <= half_width_m) return true;
    const double azimuth_rad = std::atan2(place_m.y(), place_m.x()), half_rad = std::asin(half_width_m / range_m);
    const int first = sector(azimuth_rad - half_rad), last = sector(azimuth_rad + half_rad);
    for (int k = first;; ++k) {
      if ((bits_ & bit(k)) != 0) return true;
      if (((k - last) & (kSectors - 1)) == 0) return false;
    }
  }

 private:
  static constexpr int kSectors = 64;
  [[nodiscard]] static int sector(double azimuth_rad) {
    return static_cast<int>(std::floor(azimuth_rad * (kSectors / (2.0 * M_PI))));
  }
  [[nodiscard]] static std::uint64_t bit(int sector) {
    return std::uint64_t{1} << static_cast<unsigned>(sector & (kSectors - 1));
  }
  std::uint64_t bits_ = 0;
};

}  // namespace boresight::ghosts
