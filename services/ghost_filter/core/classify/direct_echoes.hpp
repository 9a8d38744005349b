// The moving detections of one scan, to be found by direction: what a mirror sends back to the radar from where it is
// seen itself, a type-1 ghost, lies right behind a stronger echo of the same spot.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/sectors.hpp"

namespace boresight::ghosts {

/// As the sensor sees it; vehicle axes.
struct DirectEcho {
  Eigen::Vector2d direction;  ///< unit
  double range_m, range_variance_m2, azimuth_variance_rad2;
  double rate_mps;       ///< over ground
  double rcs_dbsm;       ///< NaN: not measured
  double weight;         ///< of being no ghost itself
  std::uint32_t index;   ///< in the scan
  std::uint32_t object;  ///< tracked one that it is of, or kNobody
};

class DirectEchoes {
 public:
  explicit DirectEchoes(std::size_t capacity);
  void clear();
  /// Those beyond the capacity are left out.
  void add(const DirectEcho& echo);
  /// Calls `visit(echo)` for all up to that angle to both sides of a direction (not zero), and for some more.
  template <typename Visit>
  void near(const Eigen::Vector2d& direction, double angle_rad, const Visit& visit) const {
    // Where sectors are narrowest a radian has a quarter of them.
    const double parts = std::max(0.0, angle_rad) * (kSectors / 4.0);
    const std::size_t around = std::min(kSectors / 2 - 1, 1 + static_cast<std::size_t>(std::min(parts, 1e3)));
    const std::size_t middle = sector_of<kSectors>(direction);
    for (std::size_t k = 0; k <= 2 * around; ++k) {
      for (std::uint32_t i = first_[(middle + kSectors - around + k) % kSectors]; i != kNone; i = next_[i]) {
        visit(echoes_[i]);
      }
    }
  }

 private:
  static constexpr std::size_t kSectors = 256;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<DirectEcho> echoes_;
  std::array<std::uint32_t, kSectors> first_;
  std::vector<std::uint32_t> next_;
};

}  // namespace boresight::ghosts
