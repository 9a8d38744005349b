#include "services/alignment_estimator/core/windows/block.hpp"

namespace boresight::alignment::windows {

void add_scan(Block& block, const ScanModel& model, const CurveSums& sums, const MotionVariances& variances,
              const LossFactors& factors) {
  const Eigen::Matrix<double, local::kCurve, 3> gradient = model.by_parameter;
  const Eigen::Matrix3d information = factors.information * sums.information;
  const Eigen::Vector3d score = factors.score * sums.score;
  LocalMatrix l = LocalMatrix::Zero();
  LocalVector s;
  const Eigen::Matrix<double, local::kCurve, 3> weighted = gradient * information;
  l.topLeftCorner<local::kCurve, local::kCurve>().noalias() = weighted * gradient.transpose();
  const Eigen::Matrix<double, local::kCurve, kKnots> cross =
      factors.information * (gradient * sums.curve_by_velocity.transpose());
  l.block<local::kCurve, kKnots>(0, local::kCurve) = cross;
  l.block<kKnots, local::kCurve>(local::kCurve, 0) = cross.transpose();
  for (int k = 0; k < kKnots; ++k) {
    l(local::kCurve + k, local::kCurve + k) = factors.information * sums.curve_diagonal(k);
    if (k + 1 == kKnots) continue;
    const double next = factors.information * sums.curve_next(k);
    l(local::kCurve + k, local::kCurve + k + 1) = l(local::kCurve + k + 1, local::kCurve + k) = next;
  }
  for (int k = 0; k < 2; ++k) {
    const CurveSums::Heights& of = sums.heights[static_cast<std::size_t>(k)];
    LocalVector column = LocalVector::Zero();
    column.head<local::kCurve>().noalias() = gradient * of.by_velocity;
    column.segment<kKnots>(local::kCurve) = of.by_curve;
    column(local::kAbove + k) = of.diagonal;
    column *= factors.information;
    l.col(local::kAbove + k) = column;
    l.row(local::kAbove + k) = column.transpose();
    s(local::kAbove + k) = factors.score * of.score;
  }
  s.head<local::kCurve>().noalias() = gradient * score;
  s.segment<kKnots>(local::kCurve) = factors.score * sums.curve_score;
  // The errors of the motion, one after the other: they are independent, and known to their variances.
  Eigen::Matrix<double, local::kCount, kMotionErrors> by_motion;
  by_motion.topRows<local::kCurve>().noalias() = weighted * model.by_motion.transpose();
  by_motion.middleRows<kKnots>(local::kCurve).noalias() =
      factors.information * (sums.curve_by_velocity * model.by_motion.transpose());
  for (int k = 0; k < 2; ++k) {
    by_motion.row(local::kAbove + k).noalias() =
        factors.information * (model.by_motion * sums.heights[static_cast<std::size_t>(k)].by_velocity).transpose();
  }
  Eigen::Matrix<double, kMotionErrors, kMotionErrors> own = model.by_motion * information * model.by_motion.transpose();
  Eigen::Matrix<double, kMotionErrors, 1> own_score = model.by_motion * score;
  for (int m = 0; m < kMotionErrors; ++m) {
    if (!(variances[static_cast<std::size_t>(m)] > 0.0)) continue;
    const double inverse = 1.0 / (own(m, m) + 1.0 / variances[static_cast<std::size_t>(m)]);
    const LocalVector column = by_motion.col(m);
    l.noalias() -= inverse * column * column.transpose();
    s -= inverse * own_score(m) * column;
    for (int n = m + 1; n < kMotionErrors; ++n) {
      const double share = inverse * own(m, n);
      by_motion.col(n) -= share * column;
      own_score(n) -= share * own_score(m);
      for (int k = n; k < kMotionErrors; ++k) own(n, k) -= share * own(m, k);
    }
  }
  block.information += l;
  block.score += s;
  const Eigen::Matrix<double, 4, 3> turned = gradient.middleRows<4>(local::kRateScale);
  block.wide_information.noalias() += turned * sums.wide_information * turned.transpose();
  block.wide_score.noalias() += turned * sums.wide_score;
  block.detections += sums.detections;
  block.stationary += sums.common.stationary;
  ++block.scans;
}

}  // namespace boresight::alignment::windows
