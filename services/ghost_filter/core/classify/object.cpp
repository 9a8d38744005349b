#include "services/ghost_filter/core/classify/object.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/ghost_filter/core/classify/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kWithin = 0.12;  // share of a body's reflections that come from anywhere in the box
constexpr double kEdge = 0.15;    // of a face that only one of the two ends of the path sees, beside one that both see

constexpr double kSlow_mps = 0.5;  // what is slower may as well stand

/// How much larger than its track's box a vehicle may be, on each side, and how likely that is.
struct Growth {
  double share, length_m, width_m;
};
constexpr std::array<Growth, 3> kGrowths{{{0.8, 0.0, 0.0}, {0.15, 2.5, 0.5}, {0.05, 7.0, 1.5}}};

/// Which end of an axis looks to a place: −1, 0 (beside the box, within its extent), +1.
int side(double coordinate, double half) {
  return coordinate > half ? 1 : coordinate < -half ? -1 : 0;
}

/// Everything in the box's axes: the place from the box's centre with covariance `s`, and the path's ends.
struct InBox {
  Eigen::Vector2d place, from, lit;
  Eigen::Matrix2d s;
};

Reflections reflections_of(const InBox& in, const Eigen::Vector2d& half) {
  const Eigen::Vector2d residual = in.place - in.place.cwiseMax(-half).cwiseMin(half);
  // Too far along one axis is too far.
  if (square(residual.x()) > kFarthest2 * in.s(0, 0) || square(residual.y()) > kFarthest2 * in.s(1, 1))
    return {0.0, 0.0};
  const double blur = 2.0 * M_PI * std::sqrt(std::max(1e-9, in.s(0, 0) * in.s(1, 1) - square(in.s(0, 1))));
  const double anywhere = gaussian(residual, in.s) * blur / (blur + 4.0 * half.x() * half.y());
  if (anywhere <= 0.0) return {0.0, 0.0};  // no face is nearer than the box
  double sum = 0.0, weights = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    const int seen = side(in.from(axis), half(axis)), shone = side(in.lit(axis), half(axis));
    for (const int end : {-1, 1}) {
      const double weight = seen == end && shone == end ? 1.0 : seen == end || shone == end ? kEdge : 0.0;
      if (weight <= 0.0) continue;
      weights += weight;
      const Eigen::Vector2d on(in.place(1 - axis), in.place(axis) - end * half(axis));
      Eigen::Matrix2d turned;
      turned << in.s(1 - axis, 1 - axis), in.s(0, 1), in.s(0, 1), in.s(axis, axis);
      sum += weight * on_segment(on, half(1 - axis), turned);
    }
  }
  return {weights > 0.0 ? kWithin * anywhere + (1.0 - kWithin) * sum / weights : anywhere, anywhere};
}

}  // namespace

Eigen::Vector2d most_extent(const Object& object) {
  const Eigen::Vector2d axis = object.axis.cwiseAbs();
  const double length = object.half_length_m + kGrowths.back().length_m;
  const double width = object.half_width_m + kGrowths.back().width_m;
  return {axis.x() * length + axis.y() * width, axis.y() * length + axis.x() * width};
}

Reflections reflections_at(const Object& object, const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance,
                           const Eigen::Vector2d& seen_from_m, const Eigen::Vector2d& lit_from_m) {
  const Eigen::Vector2d q = place_m - object.position_m;
  Eigen::Matrix2d axes;  // rows: the box's axes
  axes << object.axis.x(), object.axis.y(), -object.axis.y(), object.axis.x();
  const InBox in{axes * q, axes * (seen_from_m - object.position_m), axes * (lit_from_m - object.position_m),
                 axes * (covariance + object.position_covariance) * axes.transpose()};
  Reflections sum{0.0, 0.0};
  for (const Growth& growth : kGrowths) {
    const Reflections there =
        reflections_of(in, {object.half_length_m + growth.length_m, object.half_width_m + growth.width_m});
    sum.body += growth.share * there.body;
    sum.wheel += growth.share * there.wheel;
  }
  return sum;
}

bool moves_surely(const Object& object) {
  const Eigen::Matrix2d& p = object.velocity_covariance;
  const Eigen::Vector2d& v = object.velocity_mps;
  if (v.squaredNorm() < square(kSlow_mps)) return false;
  // vᵀP⁻¹v against three standard deviations.
  const double determinant = p(0, 0) * p(1, 1) - p(0, 1) * p(1, 0);
  return p(1, 1) * square(v.x()) - 2.0 * p(0, 1) * v.x() * v.y() + p(0, 0) * square(v.y()) > 9.0 * determinant;
}

double moving_of(const Object& object) {
  if (moves_surely(object)) return 1.0;
  const double speed_mps = object.velocity_mps.norm();
  if (speed_mps <= kSlow_mps) return 0.0;
  const Eigen::Vector2d course = object.velocity_mps / speed_mps;
  return below((speed_mps - kSlow_mps) / std::sqrt(std::max(1e-9, course.dot(object.velocity_covariance * course))));
}

RateDensity rates_at(const Object& object, double rate_mps, const Eigen::Vector2d& q, double noise_variance) {
  const double mean = q.dot(object.velocity_mps);
  const double variance = noise_variance + q.dot(object.velocity_covariance * q);
  const double std = std::sqrt(variance), spread = std::max(0.5, std::abs(mean));
  const double share = below((rate_mps - mean + spread) / std) - below((rate_mps - mean - spread) / std);
  return {gaussian(rate_mps - mean, variance), std::max(0.0, share) / (2.0 * spread)};
}

}  // namespace boresight::ghosts
