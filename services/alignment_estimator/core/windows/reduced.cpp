#include "services/alignment_estimator/core/windows/reduced.hpp"

namespace boresight::alignment::windows {

Reduced reduce(const Share& share, const Point& present, const std::array<double, kFluctuations>& variances) {
  constexpr double kNone = 1e18;  // precision of a fluctuation that does not exist
  Reduced r;
  r.information = share.information;
  r.score = share.score;
  r.score.noalias() += r.information * difference(present, share.point);
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
