#include "services/alignment_estimator/core/windows/reduced.hpp"

#include <Eigen/Eigenvalues>

namespace boresight::alignment::windows {

void make_positive(Share& share, const LocalVector& scale) {
  constexpr double kLeast = 1e-3;  // of the prior's information
  const LocalMatrix scaled = scale.asDiagonal() * share.information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<LocalMatrix> eigen(scaled);
  const LocalVector inverse = scale.cwiseInverse();
  const LocalVector kept = (eigen.eigenvalues().array() > kLeast).select(eigen.eigenvalues(), 0.0);
  const LocalVector is_kept = (eigen.eigenvalues().array() > kLeast).cast<double>();
  const LocalMatrix& v = eigen.eigenvectors();
  share.information.noalias() = (inverse.asDiagonal() * v) * kept.asDiagonal() * (inverse.asDiagonal() * v).transpose();
  const LocalVector along = v.transpose() * scale.cwiseProduct(share.score);
  share.score = inverse.cwiseProduct(v * is_kept.cwiseProduct(along));
  share.positive = true;
}

Reduced reduce(const Share& share, const Point& present, const std::array<double, kFluctuations>& variances,
               double roll_variance) {
  constexpr double kNone = 1e18;  // precision of a fluctuation that does not exist
  Reduced r;
  r.information = share.information;
  r.score = share.score;
  r.score.noalias() += r.information * difference(present, share.point);
  if (roll_variance > 0.0) {
    const LocalVector column = r.information.col(local::kRotation);
    const double gain = 1.0 / (column(local::kRotation) + 1.0 / roll_variance);
    r.score -= (gain * r.score(local::kRotation)) * column;
    r.information.noalias() -= gain * column * column.transpose();
  }
  FluctuationColumns columns;
  for (int k = 0; k < kFluctuations; ++k) columns.col(k) = r.information.col(kFluctuating[static_cast<std::size_t>(k)]);
  FluctuationMatrix m;
  for (int k = 0; k < kFluctuations; ++k) {
    m.row(k) = columns.row(kFluctuating[static_cast<std::size_t>(k)]);
    r.raw_score(k) = r.score(kFluctuating[static_cast<std::size_t>(k)]);
  }
  for (int k = 0; k < kFluctuations; ++k) {
    const double variance = variances[static_cast<std::size_t>(k)];
    m(k, k) += variance > 0.0 ? 1.0 / variance : kNone;
  }
  r.posterior = m.inverse();
  r.gain.noalias() = columns * r.posterior;
  r.information.noalias() -= r.gain * columns.transpose();
  r.score.noalias() -= r.gain * r.raw_score;
  return r;
}

}  // namespace boresight::alignment::windows
