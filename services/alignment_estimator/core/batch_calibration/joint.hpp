// All radars of a vehicle in one set of equations: k_v, then α, β, γ of each.
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"
#include "services/alignment_estimator/core/published/normal_equations.hpp"

namespace boresight::alignment::batch_calibration {

[[nodiscard]] inline Eigen::Index first_angle(std::size_t radar) {
  return 1 + 3 * static_cast<Eigen::Index>(radar);
}
/// (k_v, α, β, γ) of one radar.
[[nodiscard]] inline Eigen::Vector4d of_radar(const Eigen::VectorXd& parameters, std::size_t radar) {
  Eigen::Vector4d b;
  b << parameters(0), parameters.segment<3>(first_angle(radar));
  return b;
}

/// Normal equations over 1 + 3·K_r parameters; the stacked Jacobian of Burza 2025, §9 has as many columns, most of its
/// entries zero.
struct JointEquations {
  explicit JointEquations(std::size_t radars)
      : jtj(Eigen::MatrixXd::Zero(first_angle(radars), first_angle(radars))),
        jtr(Eigen::VectorXd::Zero(first_angle(radars))) {}

  void clear();
  void add(std::size_t radar, const published::NormalEquations& equations);

  Eigen::MatrixXd jtj;
  Eigen::VectorXd jtr;
  double rtr = 0.0;
  std::size_t count = 0;
};

/// Adds one detection; moves `model`, that of its radar, to the motion of the detection.
void add(const Detection& detection, published::PlanarModel& model, published::NormalEquations& equations);

/// V_JR·V_RR⁻¹ of the SVD of [J, ηR] (26)(27), by inverse iteration on its Gram matrix: the smallest singular value is
/// far below the others, so that six rounds give all digits. Zero where there is no solution.
[[nodiscard]] Eigen::VectorXd total_least_squares_step(const JointEquations& equations, double rate);

struct Solution {
  Eigen::VectorXd parameters;
  double rmse_mps = 0.0;
  bool converged = false;
};

/// Least squares by Gauss–Newton (Levenberg's damping) from `start` over all detections; `held`: indices of fixed
/// parameters.
[[nodiscard]] Solution solve(std::span<const Recording> radars, const Eigen::VectorXd& start,
                             std::span<const Eigen::Index> held = {});

/// Stds of the parameters by the information matrix of the detections, for residuals of that std, with the prior
/// `prior_angle_std_rad` of the angles. ∞ for fixed parameters.
[[nodiscard]] Eigen::VectorXd stds(std::span<const Recording> radars, const Eigen::VectorXd& parameters,
                                   std::span<const Eigen::Index> held, double residual_std_mps,
                                   double prior_angle_std_rad);

}  // namespace boresight::alignment::batch_calibration
