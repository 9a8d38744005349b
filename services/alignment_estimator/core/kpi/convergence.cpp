#include "services/alignment_estimator/core/kpi/convergence.hpp"

#include <cmath>
#include <limits>

namespace boresight::alignment {

void Convergence::add(double seconds_of_drive, std::uint64_t scans, const Eigen::Vector4d& values,
                      std::uint32_t step_changes) {
  if (!values.allFinite() || !std::isfinite(seconds_of_drive)) return;
  const Entry before = latest_;
  latest_ = {seconds_of_drive, scans, values};
  if (number_kept_ == 0) {
    kept_[number_kept_++] = latest_;
    step_changes_ = step_changes;
  } else if (step_changes != step_changes_) {
    step_changes_ = step_changes;
    kept_[0] = before;
    number_kept_ = 1;
  }
  const double since_start = seconds_of_drive - kept_[0].seconds;
  const double since_kept = seconds_of_drive - kept_[number_kept_ - 1].seconds;
  const bool is_due = since_start <= kFirst_s ? since_kept > 0.0 : since_kept >= (1.0 - 1.0 / kGrowth) * since_start;
  if (is_due && number_kept_ < kCapacity) kept_[number_kept_++] = latest_;
  const Entry& newest = minute_[(minute_next_ + kMinute) % (kMinute + 1)];
  if (minute_size_ > 0 && seconds_of_drive - newest.seconds < 1.0) return;
  minute_[minute_next_] = latest_;
  minute_next_ = (minute_next_ + 1) % (kMinute + 1);
  if (minute_size_ <= kMinute) ++minute_size_;
}

Convergence::Settled Convergence::to_95_percent(AlignmentParameter parameter, double std) const {
  constexpr double kSignificance = 5.0;
  constexpr double kLeft = 0.05;
  const Settled unknown{std::numeric_limits<double>::quiet_NaN(), 0};
  if (number_kept_ == 0) return unknown;
  const auto i = static_cast<Eigen::Index>(parameter);
  const double present = latest_.values(i);
  const double distance = std::abs(present - kept_[0].values(i));
  if (!(distance > kSignificance * std)) return unknown;
  // Backwards from the present to the last value outside the limit.
  const Entry* settled = &latest_;
  for (std::size_t k = number_kept_; k-- > 0;) {
    if (std::abs(kept_[k].values(i) - present) > kLeft * distance) break;
    settled = &kept_[k];
  }
  return {settled->seconds - kept_[0].seconds, static_cast<std::uint32_t>(settled->scans - kept_[0].scans)};
}

double Convergence::drift_per_minute(AlignmentParameter parameter) const {
  if (minute_size_ <= kMinute) return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<Eigen::Index>(parameter);
  const Entry& oldest = minute_[minute_next_];
  const double seconds = latest_.seconds - oldest.seconds;
  return 60.0 * (latest_.values(i) - oldest.values(i)) / seconds;
}

}  // namespace boresight::alignment
