#include "services/tracker/core/classical/velocity.hpp"

#include <cmath>
#include <limits>

namespace boresight::tracking::classical {

namespace {

/// Of a velocity that nothing is known of, m²/s².
constexpr double kUnknownVariance = 1e8;
/// Of MotionState.
enum StateIndex : Eigen::Index { kX, kVx, kAx, kY, kVy, kAy };

}  // namespace

filters::MotionState motion_state(const Component<double>& c, double acceleration_std_mps2) {
  filters::MotionState state;
  state.mean.setZero();
  state.covariance.setZero();
  state.mean[kX] = c.position_m.x;
  state.mean[kY] = c.position_m.y;
  state.mean[kVx] = c.velocity_mps.x;
  state.mean[kVy] = c.velocity_mps.y;
  const auto set = [&](Eigen::Index row, Eigen::Index column, double value) {
    state.covariance(row, column) = state.covariance(column, row) = value;
  };
  set(kX, kX, c.position_covariance.xx);
  set(kX, kY, c.position_covariance.xy);
  set(kY, kY, c.position_covariance.yy);
  set(kVx, kVx, c.velocity_covariance.xx);
  set(kVx, kVy, c.velocity_covariance.xy);
  set(kVy, kVy, c.velocity_covariance.yy);
  set(kX, kVx, c.position_velocity_covariance.xx);
  set(kX, kVy, c.position_velocity_covariance.xy);
  set(kY, kVx, c.position_velocity_covariance.yx);
  set(kY, kVy, c.position_velocity_covariance.yy);
  set(kAx, kAx, acceleration_std_mps2 * acceleration_std_mps2);
  set(kAy, kAy, acceleration_std_mps2 * acceleration_std_mps2);
  return state;
}

void set_kinematics(const filters::MotionState& state, Component<double>& c) {
  const auto& m = state.mean;
  const auto& p = state.covariance;
  c.position_m = {m[kX], m[kY]};
  c.velocity_mps = {m[kVx], m[kVy]};
  c.position_covariance = {p(kX, kX), p(kX, kY), p(kY, kY)};
  c.velocity_covariance = {p(kVx, kVx), p(kVx, kVy), p(kVy, kVy)};
  c.position_velocity_covariance = {p(kX, kVx), p(kX, kVy), p(kY, kVx), p(kY, kVy)};
}

CellVelocity cell_velocity(const Cell<double>& cell, const View<double>& view) {
  CellVelocity velocity;
  if (view.range_rate_variance <= 0.0) return velocity;
  const Symmetric2<double>& s = cell.sight_squares;
  const double middle = 0.5 * (s.xx + s.yy), half = std::hypot(0.5 * (s.xx - s.yy), s.xy);
  const double angle_rad = 0.5 * std::atan2(2.0 * s.xy, s.xx - s.yy);
  const Vector2<double> along{std::cos(angle_rad), std::sin(angle_rad)}, across{-along.y, along.x};
  const auto rate = [&](const Vector2<double>& e, double eigenvalue) {
    const double by_turn = dot(e, view.turn_mps);
    return filters::RangeRate{
        {e.x, e.y}, dot(e, cell.sight_rate) / eigenvalue, view.range_rate_variance / eigenvalue + by_turn * by_turn};
  };
  velocity.along = rate(along, middle + half);
  // What rounding leaves of a zero tells nothing.
  if (middle - half <= cell.n * 16.0 * std::numeric_limits<double>::epsilon()) return velocity;
  const filters::RangeRate other = rate(across, middle - half);
  const Eigen::Vector2d e1 = velocity.along->line_of_sight, e2 = other.line_of_sight;
  velocity.across = {other.mean_mps * e2,
                     kUnknownVariance * e1 * e1.transpose() + other.variance_m2ps2 * e2 * e2.transpose()};
  return velocity;
}

}  // namespace boresight::tracking::classical
