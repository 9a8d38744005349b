#include "services/tracker/core/kalman.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

using Matrix36d = Eigen::Matrix<double, 3, 6>;

/// x, y, and the velocity's share along the line of sight.
Matrix36d measurement_matrix(const PositionRate& m) {
  Matrix36d h = Matrix36d::Zero();
  h(0, 0) = 1.0;
  h(1, 1) = 1.0;
  h(2, 2) = m.line_of_sight.x();
  h(2, 3) = m.line_of_sight.y();
  return h;
}

constexpr double kStill_mps = 0.3;    // the direction of less is chance
constexpr double kTurnLasts_s = 1.0;  // until it is straight on again, or turns the other way

/// Of a vehicle's acceleration across its course: on a circle of 10 m where it is slow. At speed nobody turns so; and
/// at a walking pace places, not turns, still go to and fro.
double across_std_mps2(double speed_mps) {
  constexpr double kCurvature_per_m = 0.1, kLeast_mps2 = 0.3, kMost_mps2 = 2.0;
  return std::clamp(kCurvature_per_m * speed_mps * speed_mps, kLeast_mps2, kMost_mps2);
}

/// Seconds until what brakes stands; what is predicted on from there would drive back. Infinity: it does not brake.
double time_to_standstill(const KinematicState& state) {
  const auto velocity = state.mean.segment<2>(2);
  if (state.heading.known) {
    // What seems to go aside is noise, and keeps nobody from standing.
    const Eigen::Vector2d course(std::cos(state.heading.rad), std::sin(state.heading.rad));
    const double speed = course.dot(velocity), slows = -course.dot(state.mean.tail<2>());
    if (speed > 0.0 && slows > 0.0) return speed < kStill_mps ? 0.0 : speed / slows;
  }
  const double braking = -velocity.dot(state.mean.tail<2>());
  if (!(braking > 0.0)) return std::numeric_limits<double>::infinity();
  return velocity.norm() < kStill_mps ? 0.0 : velocity.squaredNorm() / braking;
}

void symmetrise(Matrix6d& m) {
  m = 0.5 * (m + m.transpose()).eval();
}

}  // namespace

void predict(KinematicState& state, double dt, double jerk_std_mps3, const geometry::EgoStep& ego, Moves moves) {
  const Eigen::Matrix2d eye = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d jerk = jerk_std_mps3 * jerk_std_mps3 * eye;
  Matrix6d f = Matrix6d::Identity(), q = Matrix6d::Zero();
  const double d2 = dt * dt, d3 = d2 * dt, d4 = d3 * dt, d5 = d4 * dt;
  f.block<2, 2>(0, 2) = dt * eye;
  f.block<2, 2>(0, 4) = 0.5 * d2 * eye;
  f.block<2, 2>(2, 4) = dt * eye;
  if (const double speed = state.mean.segment<2>(2).norm(); moves == Moves::kAsVehicle && speed > kStill_mps) {
    const Eigen::Vector2d course = state.mean.segment<2>(2) / speed, across(-course.y(), course.x());
    const Eigen::Matrix2d side = across * across.transpose();
    const double std = across_std_mps2(speed), stays = std::exp(-dt / kTurnLasts_s);
    jerk += (2.0 * std * std / kTurnLasts_s - jerk_std_mps3 * jerk_std_mps3) * side;
    const double faster_s = kTurnLasts_s * (1.0 - stays);
    f.block<2, 2>(0, 4) += (kTurnLasts_s * (dt - faster_s) - 0.5 * d2) * side;
    f.block<2, 2>(2, 4) += (faster_s - dt) * side;
    f.block<2, 2>(4, 4) -= (1.0 - stays) * side;
  }
  q.block<2, 2>(0, 0) = d5 / 20.0 * jerk;
  q.block<2, 2>(0, 2) = q.block<2, 2>(2, 0) = d4 / 8.0 * jerk;
  q.block<2, 2>(0, 4) = q.block<2, 2>(4, 0) = d3 / 6.0 * jerk;
  q.block<2, 2>(2, 2) = d3 / 3.0 * jerk;
  q.block<2, 2>(2, 4) = q.block<2, 2>(4, 2) = d2 / 2.0 * jerk;
  q.block<2, 2>(4, 4) = dt * jerk;
  Matrix6d turn = Matrix6d::Zero();
  for (Eigen::Index k = 0; k < 6; k += 2) turn.block<2, 2>(k, k) = ego.to_new;
  const double stands_after_s = time_to_standstill(state);
  if (stands_after_s < dt) {
    state.mean.head<2>() += stands_after_s * (state.mean.segment<2>(2) + 0.5 * stands_after_s * state.mean.tail<2>());
    state.mean.tail<4>().setZero();
  } else {
    state.mean = f * state.mean;
  }
  state.mean.head<2>() -= ego.translation_m;
  state.mean = turn * state.mean;
  const Matrix6d whole = turn * f;
  state.heading.with_rest = whole * state.heading.with_rest;
  state.covariance = whole * state.covariance * whole.transpose() + turn * q * turn.transpose();
  symmetrise(state.covariance);
}

void blur_own_turn(KinematicState& state, double variance_rad2) {
  const Eigen::Vector2d aside(-state.mean(1), state.mean(0));
  state.covariance.topLeftCorner<2, 2>() += variance_rad2 * aside * aside.transpose();
}

Distance distance(const KinematicState& state, const PositionRate& m) {
  const Matrix36d h = measurement_matrix(m);
  const Eigen::Vector3d innovation = m.value - h * state.mean;
  const Eigen::Matrix3d s = h * state.covariance * h.transpose() + m.covariance;
  const double determinant = s.determinant();
  if (!(determinant > 0.0)) return {1e12, 0.0};
  return {innovation.dot(s.inverse() * innovation), std::log(determinant)};
}

bool update(KinematicState& state, const PositionRate& m) {
  const Matrix36d h = measurement_matrix(m);
  const Eigen::Matrix3d s = h * state.covariance * h.transpose() + m.covariance;
  if (!(s.determinant() > 0.0)) return false;
  const Eigen::Matrix3d s_inverse = s.inverse();
  const Eigen::Matrix<double, 6, 3> gain = state.covariance * h.transpose() * s_inverse;
  const Eigen::Vector3d innovation = m.value - h * state.mean;
  if (state.heading.known) {
    const Eigen::Vector3d with_measured = h * state.heading.with_rest, heading_gain = s_inverse * with_measured;
    state.heading.rad = geometry::wrap_angle(state.heading.rad + heading_gain.dot(innovation));
    state.heading.with_rest -= gain * with_measured;
    state.heading.variance -= heading_gain.dot(with_measured);
  }
  state.mean += gain * innovation;
  const Matrix6d rest = Matrix6d::Identity() - gain * h;
  state.covariance = rest * state.covariance * rest.transpose() + gain * m.covariance * gain.transpose();
  symmetrise(state.covariance);
  return true;
}

void update_rate(KinematicState& state, const Eigen::Vector2d& sight, double rate_mps, double variance) {
  const Vector6d with_rate = state.covariance.middleCols<2>(2) * sight;
  const double whole = sight.dot(with_rate.segment<2>(2)) + variance;
  const double innovation = rate_mps - sight.dot(state.mean.segment<2>(2));
  if (state.heading.known) {
    const double with_heading = sight.dot(state.heading.with_rest.segment<2>(2));
    state.heading.rad = geometry::wrap_angle(state.heading.rad + with_heading / whole * innovation);
    state.heading.with_rest -= with_heading / whole * with_rate;
    state.heading.variance -= with_heading * with_heading / whole;
  }
  state.mean += innovation / whole * with_rate;
  state.covariance -= with_rate * with_rate.transpose() / whole;
  symmetrise(state.covariance);
}

void come_to_rest(KinematicState& state) {
  constexpr double kTold_mps = 0.3;  // moves by less than what is told from standing
  const Eigen::Matrix2d s = state.covariance.block<2, 2>(2, 2) + kTold_mps * kTold_mps * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 6, 2> gain = state.covariance.middleCols<2>(2) * s.inverse();
  const Eigen::Vector2d velocity = state.mean.segment<2>(2);
  // The heading stays: which way it stands is not known any better.
  state.heading.with_rest -= gain * state.heading.with_rest.segment<2>(2);
  state.mean -= gain * velocity;
  state.covariance -= gain * s * gain.transpose();
  symmetrise(state.covariance);
}

}  // namespace boresight::tracking
