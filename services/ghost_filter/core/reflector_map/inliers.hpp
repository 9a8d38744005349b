// How many of a set of points lie on a curve, for many curves: nearly all that a search costs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "services/ghost_filter/core/reflector_map/curve.hpp"

namespace boresight::ghosts {

template <std::size_t kCapacity>
class Inliers {
 public:
  /// Points beyond the capacity are left out.
  void set(std::span<const Eigen::Vector2d> points) {
    count_ = std::min(points.size(), kCapacity);
    if (count_ == 0) return;
    zero_m_ = points.front();
    for (std::size_t i = 0; i < count_; ++i) {
      const Eigen::Vector2d p = points[i] - zero_m_;  // in a frame as wide as the world the squares would lose digits
      points_[i] = {p.x(), p.y(), p.squaredNorm()};
    }
  }

  /// Number of points for which Curve::is_within(…, most_m).
  [[nodiscard]] std::size_t count(const Curve& curve, double most_m) const {
    // The same terms multiplied out and sorted, so that three products and sums are left for each point.
    const double half = 0.5 * curve.curvature_per_m;
    const Eigen::Vector2d origin = curve.origin_m - zero_m_, normal = curve.normal();
    const Eigen::Vector2d factors = normal + curve.curvature_per_m * origin;
    const double rest = normal.dot(origin) + half * (origin.squaredNorm() - most_m * most_m);
    const double x = factors.x(), y = factors.y();
    std::size_t on = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Point& p = points_[i];
      on += std::abs(x * p.x_m + y * p.y_m - half * p.square_m2 - rest) < most_m ? 1U : 0U;
    }
    return on;
  }

 private:
  struct Point {
    double x_m, y_m, square_m2;
  };
  Eigen::Vector2d zero_m_{0.0, 0.0};
  std::array<Point, kCapacity> points_{};
  std::size_t count_ = 0;
};

}  // namespace boresight::ghosts
