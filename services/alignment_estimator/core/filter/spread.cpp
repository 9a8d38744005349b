#include "services/alignment_estimator/core/filter/spread.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace boresight::alignment {

namespace {

/// The information that comes from the angles' noise is increased by this many of its stds before the rest counts as
/// real. If all detections are at one azimuth, residuals cannot separate it from the noise of range rates.
constexpr double kDoubtfulStds = 1.0;
/// Below this real share of the spread the direction is not supported: the statistics of the noise would decide.
constexpr double kMinRealShare = 0.1;

}  // namespace

void Spread::add(const Eigen::Matrix3d& information, const Eigen::Matrix3d& from_noise, double inliers, double keep) {
  information_ = keep * information_ + information;
  from_noise_ = keep * from_noise_ + from_noise;
  inliers_ = keep * inliers_ + inliers;
}

Support Spread::support(bool has_elevation, double log_noise_std) const {
  Support out;
  const double scale = information_.trace();
  if (!(scale > 0.0) || !std::isfinite(scale)) return out;
  Eigen::Matrix3d m = information_ / scale, f = from_noise_ / scale;
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
  if (root.info() != Eigen::Success) return out;
  const Eigen::Matrix3d l = root.matrixL();
  const Eigen::Matrix3d inverse = root.matrixL().solve(Eigen::Matrix3d::Identity());
  Eigen::Matrix3d share = inverse * f * inverse.transpose();
  share = (0.5 * (share + share.transpose())).eval();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(share);
  const double least = std::max(kMinRealShare, 5.0 * std::sqrt(2.0 / std::max(inliers_, 1.0)));
  const double margin = std::exp(kDoubtfulStds * log_noise_std);
  Eigen::Vector3d real = Eigen::Vector3d::Zero(), counts = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double from_noise = std::max(solver.eigenvalues()(i), 0.0);
    if (!(1.0 - margin * from_noise > least)) continue;
    real(i) = 1.0 - from_noise;
    counts(i) = 1.0;
    ++out.directions;
  }
  const Eigen::Matrix3d axes = l * solver.eigenvectors();  // m = axes·axesᵀ
  const Eigen::Matrix3d inverse_axes = solver.eigenvectors().transpose() * inverse;
  out.share = axes * real.asDiagonal() * inverse_axes;
  out.supported = axes * counts.asDiagonal() * inverse_axes;
  return out;
}

}  // namespace boresight::alignment
