#include "services/alignment_estimator/core/filter/common_pitch.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/filter/small_maths.hpp"

namespace boresight::alignment {

namespace {

constexpr double kTogether_s = 0.06;  ///< a body on its springs stays where it is
constexpr double kMean_s = 3.0;       ///< what lasts longer is the error of a mounting
constexpr double kBlock_s = 1.0, kMemory_s = 30.0;
constexpr double kMost = 5.0;
/// Stds by which the mean must stand out.
constexpr double kSignificant = 2.0;

}  // namespace

void CommonPitch::add(std::size_t radar, std::int64_t time_ns, double mean_before, double variance_before,
                      double mean_after, double variance_after) {
  if (radar >= said_.size()) return;
  const double gain = 1.0 - variance_after / variance_before;
  if (!(gain > 1e-6) || !(gain < 1.0) || !std::isfinite(mean_after)) return;
  const double raw = mean_before + (mean_after - mean_before) / gain;
  const double weight = std::sqrt(gain / (variance_before * (1.0 - gain)));
  Said& own = said_[radar];
  const double since_s = own.ever ? std::max(0.0, seconds(time_ns - own.time_ns)) : kMean_s;
  own.mean += (raw - own.mean) * std::min(1.0, since_s / kMean_s);
  own.ever = true;
  own.time_ns = time_ns;
  own.weight = weight;
  own.value = std::clamp((raw - own.mean) * weight, -kMost, kMost);
  const Said* other = nullptr;
  for (const Said& s : said_) {
    if (&s != &own && s.ever && (other == nullptr || s.time_ns > other->time_ns)) other = &s;
  }
  if (other == nullptr || std::abs(seconds(time_ns - other->time_ns)) > kTogether_s) return;
  block_ += own.value * own.weight * other->value * other->weight;
  const double block_s = seconds(time_ns - block_ns_);
  if (block_s >= 0.0 && block_s < kBlock_s) return;
  const double keep = std::exp(-kBlock_s / kMemory_s);
  sum_ = keep * sum_ + block_;
  sum_of_squares_ = keep * keep * sum_of_squares_ + block_ * block_;
  block_ = 0.0;
  block_ns_ = time_ns;
}

double CommonPitch::share() const {
  if (!(sum_of_squares_ > 0.0)) return 0.0;
  return std::clamp(sum_ / std::sqrt(sum_of_squares_) / kSignificant - 1.0, 0.0, 1.0);
}

}  // namespace boresight::alignment
