#include "services/alignment_estimator/core/windows/load_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace boresight::alignment::windows {

LoadVerdict LoadWatch::judge(const std::vector<Deviation2>& deviations) {
  constexpr double kSpread_rad = 0.00175;  // of a block of one radar, 0.1°
  double sum = 0.0, weights = 0.0, radars = 0.0;
  for (const Deviation2& d : deviations) {
    if (!d.valid || !(d.std(0) > 1e-5)) continue;
    const double weight = 1.0 / (d.std(0) * d.std(0) + kSpread_rad * kSpread_rad);
    sum += weight * d.value(0);
    weights += weight;
    radars += 1.0;
  }
  if (radars < 2.0) return {};
  const double mean = sum / weights;
  double apart = 0.0;
  for (const Deviation2& d : deviations) {
    if (d.valid && d.std(0) > 1e-5) apart += (d.value(0) - mean) * (d.value(0) - mean);
  }
  apart = std::sqrt(apart / radars);
  latest_[next_] = mean;
  next_ = (next_ + 1) % kBlocks;
  size_ = std::min(size_ + 1, kBlocks);
  if (size_ < kBlocks) return {};
  double latest = 0.0, square = 0.0;
  bool same_sign = true;
  for (const double one : latest_) {
    latest += one / kBlocks;
    square += one * one / kBlocks;
    same_sign &= one * mean > 0.0;
  }
  constexpr double kPriorWindows = 10.0;
  double scatter = config_.scatter_rad;
  if (history_size_ > 0) {
    std::array<double, kHistory> sorted = history_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(history_size_ / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(history_size_));
    const double windows = static_cast<double>(history_size_);
    scatter = (*middle / 0.6745 * windows + kPriorWindows * config_.scatter_rad) / (windows + kPriorWindows);
  }
  const double limit = std::max(config_.least_rad, config_.scatter_factor * scatter);
  const double spread = std::sqrt(std::max(square - latest * latest, 0.0));
  large_ = std::abs(mean) > 0.7 * limit && mean * latest > 0.0 ? large_ + 1 : 0;
  LoadVerdict verdict;
  verdict.suspect = large_ >= 2 && large_ <= 2 * kBlocks;
  verdict.stands_out = same_sign && std::abs(latest) > limit && spread < 0.5 * std::abs(latest) &&
                       apart < 0.7 * std::abs(latest) + kSpread_rad;
  if (std::getenv("LW"))
    std::fprintf(stderr, "m %.3f latest %.3f limit %.3f spread %.3f apart %.3f large %zu %d\n", mean * 57.3,
                 latest * 57.3, limit * 57.3, spread * 57.3, apart * 57.3, large_, verdict.stands_out);
  if (!verdict.stands_out && large_ == 0) {
    history_[history_next_] = std::abs(latest);
    history_next_ = (history_next_ + 1) % kHistory;
    history_size_ = std::min(history_size_ + 1, kHistory);
  }
  return verdict;
}

}  // namespace boresight::alignment::windows
