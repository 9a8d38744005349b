#include "services/tracker/core/heading.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

/// Update of all seven states by one number, the difference of what is measured from what is expected: its covariances
/// with the six and with the heading, and its variance.
void observe(KinematicState& state, const Vector6d& with_rest, double with_heading, double variance,
             double difference) {
  if (!(variance > 0.0)) return;
  state.mean += with_rest / variance * difference;
  state.heading.rad = geometry::wrap_angle(state.heading.rad + with_heading / variance * difference);
  state.covariance -= with_rest * with_rest.transpose() / variance;
  state.heading.with_rest -= with_rest * with_heading / variance;
  state.heading.variance -= with_heading * with_heading / variance;
}

/// Standard deviation of the direction of the velocity. What is new has a range rate, but nothing tells how fast it
/// goes across: by a derivative, what seems to go across would be sure of its direction. So it is asked how far two
/// standard deviations turn it.
double course_std_rad(const KinematicState& state) {
  constexpr double kFar = 2.0;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(state.covariance.block<2, 2>(2, 2));
  const double std_mps = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  const Eigen::Vector2d off = kFar * std_mps * axes.eigenvectors().col(1), v = state.mean.segment<2>(2);
  const auto turned_rad = [&v](const Eigen::Vector2d& to) {
    return std::abs(std::atan2(v.x() * to.y() - v.y() * to.x(), v.dot(to)));
  };
  return std::max(turned_rad(v + off), turned_rad(v - off)) / kFar;
}

}  // namespace

void begin_heading(KinematicState& state) {
  // Errors of the places that a new track was made of stay for a while: the course is not so sure as the filter has it.
  constexpr double kMinSpeed_mps = 0.5, kKnown_rad = 0.25, kMore_rad = 0.1;
  const Eigen::Vector2d v = state.mean.segment<2>(2);
  const double speed2 = v.squaredNorm();
  if (!(speed2 > kMinSpeed_mps * kMinSpeed_mps) || !(course_std_rad(state) < kKnown_rad)) return;
  const Eigen::Vector2d by_velocity(-v.y() / speed2, v.x() / speed2);
  const double variance = by_velocity.dot(state.covariance.block<2, 2>(2, 2) * by_velocity);
  state.heading.known = true;
  state.heading.rad = std::atan2(v.y(), v.x());
  state.heading.with_rest = state.covariance.middleCols<2>(2) * by_velocity;
  state.heading.variance = variance + kMore_rad * kMore_rad;
}

void begin_heading(KinematicState& state, double box_heading_rad, const Turn& turn) {
  const double rad = box_heading_rad + turn.difference_rad;
  // Nobody drives along a flank that lies across the course.
  if (Eigen::Vector2d(std::cos(rad), std::sin(rad)).dot(state.mean.segment<2>(2)) <= 0.0) return;
  state.heading = {};
  state.heading.known = true;
  state.heading.rad = geometry::wrap_angle(rad);
  state.heading.variance = turn.variance;
}

void predict_heading(KinematicState& state, double elapsed_s, double turned_rad) {
  // A turn lasts about a second. 0.1/m is the curvature of a turn at a crossing, a circle of 10 m; at speed
  // the acceleration across bounds it.
  constexpr double kCurvature_per_m = 0.1, kAcross_mps2 = 3.0, kLasts_s = 1.0;
  const double speed = state.mean.segment<2>(2).norm();
  const double turn_radps = std::min(kCurvature_per_m * speed, kAcross_mps2 / std::max(0.1, speed));
  state.heading.rad = geometry::wrap_angle(state.heading.rad - turned_rad);
  state.heading.variance += turn_radps * turn_radps * kLasts_s * elapsed_s;
}

void hold_to_heading(KinematicState& state) {
  constexpr double kSlip_mps = 0.3, kSlipShare = 0.03;
  const double c = std::cos(state.heading.rad), s = std::sin(state.heading.rad);
  const Eigen::Vector2d across(-s, c), v = state.mean.segment<2>(2);
  // Derivative of the velocity across by the heading.
  const double by_heading = -(c * v.x() + s * v.y());
  const Vector6d rest = state.covariance.middleCols<2>(2) * across + by_heading * state.heading.with_rest;
  const double own = across.dot(state.heading.with_rest.segment<2>(2)) + by_heading * state.heading.variance;
  const double slip_mps = kSlip_mps + kSlipShare * v.norm();
  const double variance = across.dot(rest.segment<2>(2)) + by_heading * own + slip_mps * slip_mps;
  observe(state, rest, own, variance, -across.dot(v));
}

void measure_heading(KinematicState& state, const Turn& turn) {
  const Heading known = state.heading;
  observe(state, known.with_rest, known.variance, known.variance + turn.variance, turn.difference_rad);
}

std::optional<Turn> turn_of_flank(const Cluster& cluster, double heading_rad) {
  constexpr double kLeast_m = 5.0, kMost_rad = 0.5;
  constexpr double kMostOff_m = 0.2;  // more is no flank, but an end as well, or another vehicle, or a ghost behind it
  constexpr double kRough_m = 0.25;   // reflections lie beside the flank by so much
  const std::size_t n = std::min<std::size_t>(cluster.number_on_outline, cluster.outline.size());
  if (n < 3) return std::nullopt;
  Eigen::Vector2d mean(0.0, 0.0);
  for (std::size_t i = 0; i < n; ++i) mean += cluster.outline[i] / static_cast<double>(n);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d d = cluster.outline[i] - mean, off(c * d.x() + s * d.y(), c * d.y() - s * d.x());
    spread += off * off.transpose() / static_cast<double>(n);
  }
  // The line's turn against the heading, by its principal axis; what is no line has no direction.
  const double difference = spread(0, 0) - spread(1, 1), turn = 0.5 * std::atan2(2.0 * spread(0, 1), difference);
  const double half = 0.5 * std::hypot(difference, 2.0 * spread(0, 1)), middle = 0.5 * spread.trace();
  const double along2 = middle + half, off2 = std::max(0.0, middle - half);
  if (off2 > kMostOff_m * kMostOff_m || std::abs(turn) > kMost_rad) return std::nullopt;
  const double flank_rad = heading_rad + turn;
  const Eigen::Vector2d along(std::cos(flank_rad), std::sin(flank_rad)), across(-along.y(), along.x());
  double first_m = 0.0, last_m = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double at_m = along.dot(cluster.outline[i] - mean);
    first_m = std::min(first_m, at_m);
    last_m = std::max(last_m, at_m);
  }
  if (last_m - first_m < kLeast_m) return std::nullopt;
  // That few points lie in a line may be chance: the radar's noise turns them, too.
  const double noise2 = cluster.weight * across.dot(cluster.covariance_m2 * across);
  return Turn{turn, (off2 + kRough_m * kRough_m + noise2) / (along2 * static_cast<double>(n))};
}

}  // namespace boresight::tracking
