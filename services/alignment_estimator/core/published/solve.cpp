// The decompositions of the published methods' steps.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "services/alignment_estimator/core/published/least_squares.hpp"
#include "services/alignment_estimator/core/published/total_least_squares.hpp"

namespace boresight::alignment::published {

namespace {

template <int N>
Eigen::Vector4d step_of(const NormalEquations& equations, double rate) {
  Eigen::Matrix<double, N + 1, N + 1> gram;
  gram.template topLeftCorner<N, N>() = equations.jtj.topLeftCorner<N, N>();
  gram.template topRightCorner<N, 1>() = rate * equations.jtr.head<N>();
  gram.template bottomLeftCorner<1, N>() = rate * equations.jtr.head<N>().transpose();
  gram(N, N) = rate * rate * equations.rtr;
  Eigen::Vector4d step = Eigen::Vector4d::Zero();
  if (!gram.allFinite()) return step;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N + 1, N + 1>> solver(gram);
  if (solver.info() != Eigen::Success) return step;
  const auto last = solver.eigenvectors().col(0);  // of the smallest singular value
  if (std::abs(last(N)) < 1e-3) return step;
  step.head<N>() = last.template head<N>() / last(N);
  return step;
}

}  // namespace

Eigen::Vector4d least_squares_step(const NormalEquations& equations, double damping, const Eigen::Vector4d& rate) {
  const Eigen::Matrix4d damped = equations.jtj + damping * Eigen::Matrix4d::Identity();
  return -rate.cwiseProduct(damped.ldlt().solve(equations.jtr));
}

Eigen::Vector4d total_least_squares_step(const NormalEquations& equations, int parameters, double rate) {
  return parameters == 2 ? step_of<2>(equations, rate) : step_of<4>(equations, rate);
}

}  // namespace boresight::alignment::published
