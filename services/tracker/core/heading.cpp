#include "services/tracker/core/heading.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

constexpr double kMinSpeed_mps = 0.5;  // the course of what is slower is not asked for

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
  constexpr double kKnown_rad = 0.25, kMore_rad = 0.1;
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

void begin_heading(KinematicState& state, double road_rad) {
  constexpr double kUnsure_mps = 2.5;  // of more than that across the road nothing is known yet
  constexpr double kAlike = 1.5;       // standard deviations across it: more rather crosses it
  constexpr double kStd_rad = 0.15;    // lane changes, and what the own course says of the road
  const Eigen::Vector2d along(std::cos(road_rad), std::sin(road_rad)), across(-along.y(), along.x());
  const Eigen::Vector2d v = state.mean.segment<2>(2);
  const auto std_mps = [&state](const Eigen::Vector2d& way) {
    return std::sqrt(std::max(0.0, way.dot(state.covariance.block<2, 2>(2, 2) * way)));
  };
  const double speed_mps = along.dot(v), across_mps = std_mps(across);
  if (!(std::abs(speed_mps) > std::max(kMinSpeed_mps, 2.0 * std_mps(along)))) return;
  if (!(across_mps < kUnsure_mps && std::abs(across.dot(v)) < kAlike * across_mps)) return;
  state.heading = {};
  state.heading.known = true;
  state.heading.rad = geometry::wrap_angle(speed_mps > 0.0 ? road_rad : road_rad + M_PI);
  state.heading.variance = kStd_rad * kStd_rad;
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

}  // namespace boresight::tracking
