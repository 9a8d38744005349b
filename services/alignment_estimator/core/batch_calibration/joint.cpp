#include "services/alignment_estimator/core/batch_calibration/joint.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace boresight::alignment::batch_calibration {

void JointEquations::clear() {
  jtj.setZero();
  jtr.setZero();
  rtr = 0.0;
  count = 0;
}

void JointEquations::add(std::size_t radar, const published::NormalEquations& equations) {
  const Eigen::Index at = first_angle(radar);
  jtj(0, 0) += equations.jtj(0, 0);
  jtj.block<1, 3>(0, at) += equations.jtj.topRightCorner<1, 3>();
  jtj.block<3, 1>(at, 0) += equations.jtj.bottomLeftCorner<3, 1>();
  jtj.block<3, 3>(at, at) += equations.jtj.bottomRightCorner<3, 3>();
  jtr(0) += equations.jtr(0);
  jtr.segment<3>(at) += equations.jtr.tail<3>();
  rtr += equations.rtr;
  count += equations.count;
}

void add(const Detection& detection, published::PlanarModel& model, published::NormalEquations& equations) {
  model.move(detection.speed_mps, detection.yaw_rate_radps);
  const published::RangeRate predicted = model(detection.azimuth_rad, detection.elevation_rad);
  equations.add(predicted.gradient, predicted.value_mps - detection.range_rate_mps);
}

Eigen::VectorXd total_least_squares_step(const JointEquations& equations, double rate) {
  const Eigen::Index n = equations.jtr.size();
  Eigen::MatrixXd gram(n + 1, n + 1);
  gram.topLeftCorner(n, n) = equations.jtj;
  gram.topRightCorner(n, 1) = rate * equations.jtr;
  gram.bottomLeftCorner(1, n) = rate * equations.jtr.transpose();
  gram(n, n) = rate * rate * equations.rtr;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
  if (!gram.allFinite()) return none;
  const Eigen::LDLT<Eigen::MatrixXd> factor(gram);
  Eigen::VectorXd last = Eigen::VectorXd::Unit(n + 1, n);
  for (int round = 0; round < 6; ++round) {
    last = factor.solve(last).eval();
    const double norm = last.norm();
    if (!std::isfinite(norm) || norm <= 0.0) return none;
    last /= norm;
  }
  if (std::abs(last(n)) < 1e-3) return none;
  return last.head(n) / last(n);
}

namespace {

constexpr int kMaxIterations = 40;

JointEquations equations_at(std::span<const Recording> radars, const Eigen::VectorXd& parameters,
                            std::span<const Eigen::Index> held) {
  JointEquations joint(radars.size());
  for (std::size_t r = 0; r < radars.size(); ++r) {
    published::NormalEquations equations;
    published::PlanarModel model(radars[r].nominal, of_radar(parameters, r), 0.0, 0.0);
    for (const Detection& d : radars[r].detections) add(d, model, equations);
    joint.add(r, equations);
  }
  for (const Eigen::Index i : held) {
    joint.jtj.row(i).setZero();
    joint.jtj.col(i).setZero();
    joint.jtj(i, i) = 1.0;
    joint.jtr(i) = 0.0;
  }
  return joint;
}

}  // namespace

Solution solve(std::span<const Recording> radars, const Eigen::VectorXd& start, std::span<const Eigen::Index> held) {
  Solution solution{start, 0.0, false};
  JointEquations now = equations_at(radars, solution.parameters, held);
  if (now.count == 0 || !std::isfinite(now.rtr)) return solution;
  double damping = 1e-6;
  for (int i = 0; i < kMaxIterations && !solution.converged; ++i) {
    Eigen::MatrixXd damped = now.jtj;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-12;
    const Eigen::VectorXd step = -damped.ldlt().solve(now.jtr);
    if (!step.allFinite()) break;
    const Eigen::VectorXd there = solution.parameters + step;
    JointEquations next = equations_at(radars, there, held);
    if (next.rtr <= now.rtr) {
      solution.converged = step.cwiseAbs().maxCoeff() < 1e-8;
      solution.parameters = there;
      now = std::move(next);
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      // At the minimum, rounding decides which of two costs is smaller.
      solution.converged = step.cwiseAbs().maxCoeff() < 1e-7;
      damping *= 10.0;
    }
  }
  solution.rmse_mps = std::sqrt(now.rtr / static_cast<double>(now.count));
  return solution;
}

Eigen::VectorXd stds(std::span<const Recording> radars, const Eigen::VectorXd& parameters,
                     std::span<const Eigen::Index> held, double residual_std_mps, double prior_angle_std_rad) {
  const double variance = std::max(residual_std_mps * residual_std_mps, 1e-12);
  Eigen::MatrixXd information = equations_at(radars, parameters, held).jtj / variance;
  information.diagonal().tail(parameters.size() - 1).array() += 1.0 / (prior_angle_std_rad * prior_angle_std_rad);
  const Eigen::MatrixXd covariance =
      information.ldlt().solve(Eigen::MatrixXd::Identity(parameters.size(), parameters.size()));
  Eigen::VectorXd result = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (const Eigen::Index i : held) result(i) = std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace boresight::alignment::batch_calibration
