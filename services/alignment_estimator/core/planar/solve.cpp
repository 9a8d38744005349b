#include "services/alignment_estimator/core/planar/solve.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace boresight::alignment::planar {

Parameters solve(const Square& system, const Parameters& right) {
  return system.partialPivLu().solve(right);
}

Square solve_columns(const Square& system, const Square& right) {
  return system.partialPivLu().solve(right);
}

Quotients generalized_eigenvalues(const Eigen::Matrix4d& a, const Eigen::Matrix4d& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix4d> solver(a, b);
  if (solver.info() != Eigen::Success) return {};
  return {true, solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace boresight::alignment::planar
