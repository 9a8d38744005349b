// Constant-acceleration Kalman filter in the plane: state (x, y, v_x, v_y, a_x, a_y), position in the vehicle frame,
// velocity and acceleration over ground in vehicle axes (the 4D chain design; docs/algorithms/tracking.md (T1)–(T5)).
#pragma once

#include <Eigen/Core>

#include "services/common/geometry/ego_step.hpp"

namespace boresight::tracking {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Seventh state of what is known to be a vehicle that drives (heading.hpp).
struct Heading {
  bool known = false;
  double rad = 0.0;  ///< vehicle axes
  double variance = 0.0;
  Vector6d with_rest = Vector6d::Zero();  ///< covariance with the other states
};

struct KinematicState {
  Vector6d mean = Vector6d::Zero();
  Matrix6d covariance = Matrix6d::Identity();
  Heading heading;
};

/// Position (m) and range rate over ground (m/s) along a line of sight, and their covariance: rows x, y, ṙ.
struct PositionRate {
  Eigen::Vector3d value;
  Eigen::Matrix3d covariance;
  Eigen::Vector2d line_of_sight;  ///< from the sensor: unit vector, or the mean of several
};

/// What may change the acceleration: people go any way; who drives a vehicle gives gas and brakes along its course, but
/// across it nothing but a turn accelerates, and hardly at all what is slow.
enum class Moves { kAnyWay, kAsVehicle };

/// Predicts over `elapsed_s` ≥ 0 with white jerk of spectral density jerk_std², then moves the state to the new
/// vehicle frame; all but the heading (predict_heading). What brakes comes to a stand and does not drive back. Across a
/// vehicle's course the acceleration is a Gauss–Markov process of a second (Singer's model).
void predict(KinematicState& state, double elapsed_s, double jerk_std_mps3, const geometry::EgoStep& ego,
             Moves moves = Moves::kAnyWay);

/// Adds what an error of the vehicle's own turn (rad²) does to the place: it moves aside what is far away.
void blur_own_turn(KinematicState& state, double variance_rad2);

/// Squared Mahalanobis distance of a measurement from the prediction, and the logarithm of the determinant of the
/// innovation's covariance.
struct Distance {
  double squared;
  double log_determinant;
};
[[nodiscard]] Distance distance(const KinematicState& state, const PositionRate& measurement);

/// What seems to stand has no velocity, as far as a radar that calls it stationary can tell.
void come_to_rest(KinematicState& state);

/// Update in Joseph form, symmetrised. A singular innovation covariance leaves the state alone and returns false.
bool update(KinematicState& state, const PositionRate& measurement);

/// Update by a range rate over ground alone, along a unit vector; variance > 0, m²/s².
void update_rate(KinematicState& state, const Eigen::Vector2d& sight, double rate_mps, double variance);

}  // namespace boresight::tracking
