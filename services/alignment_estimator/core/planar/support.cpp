#include "services/alignment_estimator/core/planar/support.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/alignment_estimator/core/planar/solve.hpp"

namespace boresight::alignment::planar {

namespace {

constexpr std::array<Eigen::Index, 4> kPlaces{parameter::kSpeedScale, parameter::kAlpha, parameter::kBeta,
                                              parameter::kGamma};

Eigen::Matrix4d without_yaw_rate(const Square& m) {
  Eigen::Matrix4d out;
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      out(i, j) = m(kPlaces[static_cast<std::size_t>(i)], kPlaces[static_cast<std::size_t>(j)]);
    }
  }
  return out;
}

}  // namespace

void Support::add(const Sums& sums, double keep) {
  information_ = keep * information_ + without_yaw_rate(sums.information);
  from_noise_ = keep * from_noise_ + without_yaw_rate(sums.from_noise);
  inliers_ = keep * inliers_ + sums.inliers;
  elevation_ = keep * elevation_ + sums.elevation;
  elevation_square_ = keep * elevation_square_ + sums.elevation_square;
  elevation_variance_ = keep * elevation_variance_ + sums.elevation_variance;
}

void Support::renew(bool has_elevation) {
  share_.setZero();
  kept_.setZero();
  share_(parameter::kYawRateError, parameter::kYawRateError) = 1.0;
  kept_(parameter::kYawRateError, parameter::kYawRateError) = 1.0;
  // Without information the largest quotient is 1 plus some stds of a mean square.
  const double limit = 1.0 + std::max(0.25, 5.0 * std::sqrt(2.0 / std::max(inliers_, 1.0)));
  has_elevation_ = has_elevation && inliers_ > 0.0 &&
                   elevation_square_ - elevation_ * elevation_ / inliers_ > limit * elevation_variance_;
  if (!has_elevation_) {
    for (const Eigen::Index i : {parameter::kSpeedScale, parameter::kAlpha}) share_(i, i) = kept_(i, i) = 1.0;
    return;
  }
  // Units in which the information has a unit diagonal; never singular, even for noise-free angles.
  const Eigen::Vector4d scale = (information_.diagonal().array() + 1e-12).sqrt();
  const Eigen::Vector4d inverse = scale.cwiseInverse();
  const Eigen::Matrix4d real = inverse.asDiagonal() * information_ * inverse.asDiagonal();
  Eigen::Matrix4d noise = inverse.asDiagonal() * from_noise_ * inverse.asDiagonal();
  noise.diagonal().array() += 1e-9;
  const Quotients quotients = generalized_eigenvalues(real, noise);
  if (!quotients.found) return;
  Eigen::Vector4d share = Eigen::Vector4d::Zero(), kept = Eigen::Vector4d::Zero();
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double quotient = quotients.values(i);
    if (!(quotient > limit)) continue;
    kept(i) = 1.0;
    share(i) = std::sqrt(1.0 - 1.0 / quotient);
  }
  const Eigen::Matrix4d& v = quotients.vectors;
  const Eigen::Matrix4d to = scale.asDiagonal() * noise * v;
  const Eigen::Matrix4d from = v.transpose() * inverse.asDiagonal();
  const Eigen::Matrix4d share4 = to * share.asDiagonal() * from, kept4 = to * kept.asDiagonal() * from;
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const Eigen::Index a = kPlaces[static_cast<std::size_t>(i)], b = kPlaces[static_cast<std::size_t>(j)];
      share_(a, b) = share4(i, j);
      kept_(a, b) = kept4(i, j);
    }
  }
}

}  // namespace boresight::alignment::planar
