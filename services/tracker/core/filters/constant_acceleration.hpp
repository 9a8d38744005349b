// Constant acceleration in a plane or in space: the state has place, velocity and acceleration of each axis, one axis
// after the other: [x, v_x, a_x, y, v_y, a_y].
#pragma once

#include "services/tracker/core/filters/axis_motion.hpp"
#include "services/tracker/core/filters/noise.hpp"

namespace boresight::tracking::filters {

template <typename Real, int Axes>
class ConstantAcceleration {
 public:
  using Scalar = Real;
  using State = Vector<Real, 3 * Axes>;
  using Transition = Matrix<Real, 3 * Axes, 3 * Axes>;

  /// The same noise along each axis, from white jerk. Time and noise are valid.
  ConstantAcceleration(double elapsed_s, const ProcessNoise& noise) {
    const AxisMotion axis = set_transition(elapsed_s, noise);
    Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
    // A step back, or one without noise, has none.
    if (!cholesky(axis.covariance, root)) root.setZero();
    for (int i = 0; i < 3 * Axes; i += 3) {
      noise_.covariance.template block<3, 3>(i, i) = axis.covariance.template cast<Real>();
      noise_.root.template block<3, 3>(i, i) = root.template cast<Real>();
    }
  }
  /// Independent noise of each component in each step (Liang and Guo 2016).
  ConstantAcceleration(double elapsed_s, const Vector<double, 3 * Axes>& std) {
    set_transition(elapsed_s, {0.0});
    noise_ = independent_noise<Real, 3 * Axes>(std);
  }

  /// Without noise.
  void move(State& state) const {
    for (int i = 0; i < 3 * Axes; i += 3) {
      state(i) += velocity_to_place_ * state(i + 1) + acceleration_to_place_ * state(i + 2);
      state(i + 1) += acceleration_to_velocity_ * state(i + 2);
      state(i + 2) *= acceleration_kept_;
    }
  }
  /// Each column as if it were a state.
  void move_columns(Transition& columns) const {
    for (int j = 0; j < 3 * Axes; ++j) {
      for (int i = 0; i < 3 * Axes; i += 3) {
        columns(i, j) += velocity_to_place_ * columns(i + 1, j) + acceleration_to_place_ * columns(i + 2, j);
        columns(i + 1, j) += acceleration_to_velocity_ * columns(i + 2, j);
        columns(i + 2, j) *= acceleration_kept_;
      }
    }
  }
  [[nodiscard]] Transition transition() const {
    Transition matrix = Transition::Identity();
    move_columns(matrix);
    return matrix;
  }
  [[nodiscard]] const Noise<Real, 3 * Axes>& noise() const { return noise_; }

 private:
  AxisMotion set_transition(double elapsed_s, const ProcessNoise& noise) {
    const AxisMotion axis = axis_motion(elapsed_s, noise);
    velocity_to_place_ = static_cast<Real>(axis.transition(0, 1));
    acceleration_to_place_ = static_cast<Real>(axis.transition(0, 2));
    acceleration_to_velocity_ = static_cast<Real>(axis.transition(1, 2));
    acceleration_kept_ = static_cast<Real>(axis.transition(2, 2));
    return axis;
  }

  Real velocity_to_place_, acceleration_to_place_, acceleration_to_velocity_, acceleration_kept_;
  Noise<Real, 3 * Axes> noise_;
};

}  // namespace boresight::tracking::filters
