// The decompositions of the planar method, compiled once and apart: they take longer to compile than the filter itself.
#pragma once

#include <Eigen/Core>

#include "services/alignment_estimator/core/planar/planar_sums.hpp"

namespace boresight::alignment::planar {

/// The x of system·x = right, by LU decomposition with partial pivoting. Where `system` is singular, x is not finite.
[[nodiscard]] Parameters solve(const Square& system, const Parameters& right);
[[nodiscard]] Square solve_columns(const Square& system, const Square& right);

/// Quotients λ and vectors v (columns) of a·v = λ·b·v, ascending, vᵀ·b·v = 1.
struct Quotients {
  bool found = false;  ///< false: the iteration did not converge
  Eigen::Vector4d values = Eigen::Vector4d::Zero();
  Eigen::Matrix4d vectors = Eigen::Matrix4d::Zero();
};
/// `a` symmetric, `b` symmetric and positive definite.
[[nodiscard]] Quotients generalized_eigenvalues(const Eigen::Matrix4d& a, const Eigen::Matrix4d& b);

}  // namespace boresight::alignment::planar
