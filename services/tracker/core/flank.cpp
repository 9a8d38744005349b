#include "services/tracker/core/flank.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace boresight::tracking {

namespace {

constexpr double kLeast_m = 5.0, kMost_rad = 0.5;
constexpr double kSideScatter_m = 0.25;  // std of the reflections across the side of a vehicle

using Points = std::array<Eigen::Vector2d, std::tuple_size_v<decltype(Cluster::outline)>>;
using Mask = std::uint32_t;
static_assert(std::tuple_size_v<Points> <= 32);

/// Those of the points that lie on the line through two of them that has the most; of two such, the nearest ones.
/// Hardly anything is on the sensor's side of a flank: a line through the nearer corner of another vehicle is none.
Mask on_line(const Points& points, std::size_t n, double within_m, const Eigen::Vector2d& sensor) {
  constexpr std::size_t kOneOf = 5;
  Mask best = 0;
  std::size_t most = 0;
  double least_off_m = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Eigen::Vector2d along = points[j] - points[i];
      const double length_m = along.norm();
      if (length_m < kLeast_m || std::abs(along.y()) > kMost_rad * std::abs(along.x())) continue;
      const Eigen::Vector2d across = Eigen::Vector2d(-along.y(), along.x()) / length_m;
      const double side = std::copysign(1.0, across.dot(sensor - points[i]));
      Mask mask = 0;
      std::size_t number = 0, outside = 0;
      double off_m = 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        const double off = side * across.dot(points[k] - points[i]);
        outside += off >= within_m ? 1 : 0;
        if (std::abs(off) >= within_m) continue;
        mask |= Mask{1} << k;
        ++number;
        off_m += std::abs(off);
      }
      if (kOneOf * outside > n || number < most || (number == most && off_m >= least_off_m)) continue;
      best = mask;
      most = number;
      least_off_m = off_m;
    }
  }
  return best;
}

}  // namespace

std::optional<Turn> turn_of_flank(const Cluster& cluster, double heading_rad, const Eigen::Vector2d& sensor_m,
                                  bool is_long) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const auto along_heading = [c, s](const Eigen::Vector2d& v) -> Eigen::Vector2d {
    return {c * v.x() + s * v.y(), c * v.y() - s * v.x()};
  };
  const auto variance_across = [&](double turn_rad) {
    const Eigen::Vector2d across(-std::sin(heading_rad + turn_rad), std::cos(heading_rad + turn_rad));
    return cluster.weight * across.dot(cluster.covariance_m2 * across);
  };
  const std::size_t all = cluster.number_on_outline;
  Points points;  // in axes along and across the heading
  for (std::size_t i = 0; i < all; ++i) points[i] = along_heading(cluster.outline[i]);
  const Mask flank = on_line(points, all, kSideScatter_m + std::sqrt(variance_across(0.0)), along_heading(sensor_m));
  std::size_t number = 0;
  Eigen::Vector2d sum(0.0, 0.0);
  for (std::size_t i = 0; i < all; ++i) {
    if ((flank >> i & 1u) == 0) continue;
    ++number;
    sum += points[i];
  }
  if (number < 3 || (is_long ? 3 * number < all : number < all)) return std::nullopt;
  const auto n = static_cast<double>(number);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < all; ++i) {
    const Eigen::Vector2d off = points[i] - sum / n;
    if ((flank >> i & 1u) != 0) spread += off * off.transpose() / n;
  }
  // The line's turn against the heading, by its principal axis.
  const double difference = spread(0, 0) - spread(1, 1), turn = 0.5 * std::atan2(2.0 * spread(0, 1), difference);
  const double half = 0.5 * std::hypot(difference, 2.0 * spread(0, 1)), middle = 0.5 * spread.trace();
  const double along2 = middle + half, across2 = std::max(0.0, middle - half);
  if (std::abs(turn) > kMost_rad) return std::nullopt;
  // That few points lie in a line may be chance: the radar's noise turns them, too.
  return Turn{turn, (across2 + kSideScatter_m * kSideScatter_m + variance_across(turn)) / (along2 * n)};
}

}  // namespace boresight::tracking
