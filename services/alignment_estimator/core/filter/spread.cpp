#include "services/alignment_estimator/core/filter/spread.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace boresight::alignment {

namespace {

/// What the angles' noise feigns is taken off this many times before anything counts as real: how large the noise is,
/// is not known better, and where one azimuth is all there is no residual tells it from the noise of range rates.
constexpr double kFeignedMargin = 2.0;
/// Where less than this share of the spread is real then, the noise's own statistics decide, not the scene.
constexpr double kMinRealShare = 0.1;

}  // namespace

void Spread::add(const Eigen::Matrix3d& information, const Eigen::Matrix3d& feigned, double inliers, double keep) {
  information_ = keep * information_ + information;
  feigned_ = keep * feigned_ + feigned;
  inliers_ = keep * inliers_ + inliers;
}

Eigen::Matrix3d Spread::support(bool has_elevation) const {
  const double scale = information_.trace();
  if (!(scale > 0.0) || !std::isfinite(scale)) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d m = information_ / scale, f = feigned_ / scale;
  m.diagonal().array() += 1e-9;
  f.diagonal().array() += 1e-9;
  if (!has_elevation) {
    m.row(2).setZero();
    m.col(2).setZero();
    f.row(2).setZero();
    f.col(2).setZero();
    m(2, 2) = f(2, 2) = 1.0;
  }
  const Eigen::LLT<Eigen::Matrix3d> root(m);
  if (root.info() != Eigen::Success) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d l = root.matrixL();
  const Eigen::Matrix3d inverse = root.matrixL().solve(Eigen::Matrix3d::Identity());
  Eigen::Matrix3d share = inverse * f * inverse.transpose();
  share = (0.5 * (share + share.transpose())).eval();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(share);
  const double least = std::max(kMinRealShare, 5.0 * std::sqrt(2.0 / std::max(inliers_, 1.0)));
  Eigen::Vector3d real;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double feigned = solver.eigenvalues()(i);
    real(i) = 1.0 - kFeignedMargin * feigned > least ? std::min(1.0 - feigned, 1.0) : 0.0;
  }
  const Eigen::Matrix3d& axes = solver.eigenvectors();
  return l * axes * real.asDiagonal() * axes.transpose() * inverse;
}

}  // namespace boresight::alignment
