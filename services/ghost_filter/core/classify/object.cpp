#include "services/ghost_filter/core/classify/object.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/ghost_filter/core/classify/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kWithin = 0.12;  // share of a body's reflections that come from anywhere in the box
constexpr double kEdge = 0.15;    // of a face that only one of the two ends of the path sees, beside one that both see

/// How much larger than its track's box a vehicle may be, on each side, and how likely that is.
struct Growth {
  double share, length_m, width_m;
};
constexpr std::array<Growth, 3> kGrowths{{{0.8, 0.0, 0.0}, {0.15, 2.5, 0.5}, {0.05, 7.0, 1.5}}};

/// Which end of an axis looks to a place: −1, 0 (beside the box, within its extent), +1.
int side(double coordinate, double half) {
  return coordinate > half ? 1 : coordinate < -half ? -1 : 0;
}

}  // namespace

Reflections reflections_at(const Object& object, const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance,
                           const Eigen::Vector2d& seen_from_m, const Eigen::Vector2d& lit_from_m) {
  const Eigen::Vector2d q = place_m - object.position_m;
  const double reach = object.half_length_m + object.half_width_m +
                       7.1 * std::sqrt(covariance.trace() + object.position_covariance.trace());
  if (q.squaredNorm() > reach * reach) return {0.0, 0.0};
  Eigen::Matrix2d axes;  // rows: the box's axes
  axes << object.axis.x(), object.axis.y(), -object.axis.y(), object.axis.x();
  const Eigen::Vector2d local = axes * q;
  const Eigen::Vector2d half(object.half_length_m, object.half_width_m);
  const Eigen::Matrix2d s = axes * (covariance + object.position_covariance) * axes.transpose();
  const Eigen::Vector2d from = axes * (seen_from_m - object.position_m), lit = axes * (lit_from_m - object.position_m);

  const Eigen::Vector2d residual = local - local.cwiseMax(-half).cwiseMin(half);
  const double blur = 2.0 * M_PI * std::sqrt(std::max(1e-9, s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0)));
  const double anywhere = gaussian(residual, s) * blur / (blur + 4.0 * half.x() * half.y());
  double sum = 0.0, weights = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    const int seen = side(from(axis), half(axis)), shone = side(lit(axis), half(axis));
    for (const int end : {-1, 1}) {
      const double weight = seen == end && shone == end ? 1.0 : seen == end || shone == end ? kEdge : 0.0;
      if (weight <= 0.0) continue;
      weights += weight;
      const double across = local(axis) - end * half(axis);
      const Eigen::Vector2d on(local(1 - axis), across);
      Eigen::Matrix2d turned;
      turned << s(1 - axis, 1 - axis), s(0, 1), s(0, 1), s(axis, axis);
      sum += weight * on_segment(on, half(1 - axis), turned);
    }
  }
  return {weights > 0.0 ? kWithin * anywhere + (1.0 - kWithin) * sum / weights : anywhere, anywhere};
}

Reflections reflections_of_grown(const Object& object, const Eigen::Vector2d& place_m,
                                 const Eigen::Matrix2d& covariance, const Eigen::Vector2d& seen_from_m,
                                 const Eigen::Vector2d& lit_from_m) {
  Reflections sum{0.0, 0.0};
  // Nearly all objects are far away: told without a root, by (a + b)² ≤ 2 a² + 2 b².
  const double size = object.half_length_m + object.half_width_m + kGrowths.back().length_m + kGrowths.back().width_m;
  const double spread = covariance.trace() + object.position_covariance.trace();
  if ((place_m - object.position_m).squaredNorm() > 2.0 * (size * size + 7.1 * 7.1 * spread)) return sum;
  Object grown = object;
  for (const Growth& growth : kGrowths) {
    grown.half_length_m = object.half_length_m + growth.length_m;
    grown.half_width_m = object.half_width_m + growth.width_m;
    const Reflections there = reflections_at(grown, place_m, covariance, seen_from_m, lit_from_m);
    sum.body += growth.share * there.body;
    sum.wheel += growth.share * there.wheel;
  }
  return sum;
}

RateDensity rates_at(const Object& object, double rate_mps, const Eigen::Vector2d& q, double noise_variance) {
  const double mean = q.dot(object.velocity_mps);
  const double variance = noise_variance + q.dot(object.velocity_covariance * q);
  const double std = std::sqrt(variance), spread = std::max(0.5, std::abs(mean));
  const double share = below((rate_mps - mean + spread) / std) - below((rate_mps - mean - spread) / std);
  return {gaussian(rate_mps - mean, variance), std::max(0.0, share) / (2.0 * spread)};
}

}  // namespace boresight::ghosts
