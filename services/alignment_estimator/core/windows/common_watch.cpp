#include "services/alignment_estimator/core/windows/common_watch.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"

namespace boresight::alignment::windows {

namespace {

/// A step is looked for among these and older blocks; it is reported when it is old enough.
constexpr std::size_t kMinAfter = 4;
/// Largest correlation of two neighbouring blocks that is believed.
constexpr double kMaxCorrelation = 0.95;

}  // namespace

std::optional<CommonStep> CommonWatch::add(double value) {
  if (size_ == kHistory) {
    std::copy(values_.begin() + 1, values_.end(), values_.begin());
    --size_;
  }
  values_[size_++] = value;
  if (size_ < kMinBefore + config_.after) return std::nullopt;
  // Sums of the values and of their products with the next one, from the newest to the oldest.
  double total = 0.0, squares = 0.0, products = 0.0;
  for (std::size_t i = 0; i < size_; ++i) {
    total += values_[i];
    squares += square(values_[i]);
    if (i > 0) products += values_[i] * values_[i - 1];
  }
  const auto all = static_cast<double>(size_);
  double after_sum = 0.0, largest = 0.0;
  std::optional<CommonStep> best;
  for (std::size_t n = 1; n <= kMaxAfter && size_ - n >= kMinBefore; ++n) {
    after_sum += values_[size_ - n];
    if (n < kMinAfter) continue;
    const auto after = static_cast<double>(n), before = all - after;
    const double after_mean = after_sum / after, before_mean = (total - after_sum) / before;
    const double scatter_sum = squares - after * square(after_mean) - before * square(before_mean);
    const double variance =
        (std::max(scatter_sum, 0.0) + config_.prior_blocks * square(config_.scatter)) / (all + config_.prior_blocks);
    // Products of neighbours around the two means: without that across the step.
    const std::size_t first = size_ - n;
    const double ends_after = values_[first] + values_[size_ - 1], ends_before = values_[0] + values_[first - 1];
    const double sum_after = 2.0 * after_sum - ends_after, sum_before = 2.0 * (total - after_sum) - ends_before;
    const double covariance_sum = products - values_[first] * values_[first - 1] - after_mean * sum_after -
                                  before_mean * sum_before + (after - 1.0) * square(after_mean) +
                                  (before - 1.0) * square(before_mean);
    const double correlation =
        std::clamp(covariance_sum / ((all + config_.prior_blocks) * variance), 0.0, kMaxCorrelation);
    const double std = std::sqrt(variance * (1.0 + correlation) / (1.0 - correlation) * (1.0 / after + 1.0 / before));
    const double size = after_mean - before_mean;
    if (!(std::abs(size) / std > largest)) continue;
    largest = std::abs(size) / std;
    double later = 0.0;
    for (std::size_t i = size_ - n / 2; i < size_; ++i)
      later += (values_[i] - before_mean) / static_cast<double>(n / 2);
    const bool stays = later / size > config_.later_share;
    best.reset();
    if (n >= config_.after && stays && std::abs(size) > config_.least && largest > config_.stds)
      best = CommonStep{size, std, n};
  }
  if (!best) return std::nullopt;
  std::copy(values_.begin() + static_cast<std::ptrdiff_t>(size_ - best->blocks_ago),
            values_.begin() + static_cast<std::ptrdiff_t>(size_), values_.begin());
  size_ = best->blocks_ago;
  return best;
}

std::optional<double> common_mean(const std::vector<double>& values, const std::vector<double>& stds, double spread) {
  double sum = 0.0, weights = 0.0;
  std::size_t radars = 0;
  for (std::size_t r = 0; r < values.size(); ++r) {
    if (!(stds[r] > 0.0)) continue;
    const double weight = 1.0 / (square(stds[r]) + square(spread));
    sum += weight * values[r];
    weights += weight;
    ++radars;
  }
  if (radars < 2) return std::nullopt;
  return sum / weights;
}

}  // namespace boresight::alignment::windows
