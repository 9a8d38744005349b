// Sums and samples from which figures are made; those of several drives can be merged.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace boresight::bench::realism {

inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kPercent = 100.0;
inline constexpr double kEverywhere = std::numeric_limits<double>::infinity();

/// Share of cases, in percent.
struct Share {
  std::size_t yes = 0, of = 0;
  void add(bool is_so) {
    yes += is_so ? 1 : 0;
    ++of;
  }
  void merge(const Share& other) {
    yes += other.yes;
    of += other.of;
  }
  [[nodiscard]] double value() const {
    return of == 0 ? kNoFigure : static_cast<double>(yes) / static_cast<double>(of);
  }
  [[nodiscard]] double percent() const { return kPercent * value(); }
};

/// As bench::quantile, by selection: sorting millions of values for each row would cost as much as a drive.
template <typename Value>
[[nodiscard]] double quantile_of(std::vector<Value> values, double share) {
  if (values.empty()) return kNoFigure;
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), below, values.end());
  const double low = static_cast<double>(*below), weight = place - std::floor(place);
  if (below + 1 == values.end()) return low;
  return low + weight * (static_cast<double>(*std::min_element(below + 1, values.end())) - low);
}

/// Values of one quantity. NaN without values.
class Samples {
 public:
  void add(double value) { values_.push_back(static_cast<float>(value)); }
  void merge(const Samples& other) { values_.insert(values_.end(), other.values_.begin(), other.values_.end()); }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }
  [[nodiscard]] double quantile(double share) const { return quantile_of(values_, share); }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const float v : values_) sum += static_cast<double>(v);
    return values_.empty() ? kNoFigure : sum / static_cast<double>(values_.size());
  }
  [[nodiscard]] double std_dev() const {
    const double middle = mean();
    double squares = 0.0;
    for (const float v : values_) squares += (static_cast<double>(v) - middle) * (static_cast<double>(v) - middle);
    return values_.size() < 2 ? kNoFigure : std::sqrt(squares / static_cast<double>(values_.size() - 1));
  }
  [[nodiscard]] double percent_above(double limit) const {
    Share share;
    for (const float v : values_) share.add(static_cast<double>(v) > limit);
    return share.percent();
  }
  /// 1.4826 · median of the absolute deviations from the median: the sd of a normal distribution.
  [[nodiscard]] double robust_std() const {
    const double middle = quantile(0.5);
    std::vector<double> from_middle;
    for (const float v : values_) from_middle.push_back(std::abs(static_cast<double>(v) - middle));
    return 1.4826 * quantile_of(std::move(from_middle), 0.5);
  }

 private:
  std::vector<float> values_;
};

/// Mean and variance within groups, each about its own mean.
struct WithinGroups {
  double squares = 0.0, freedom = 0.0, sum = 0.0, count = 0.0;
  void add_group(const std::vector<double>& values) {
    if (values.size() < 2) return;
    double total = 0.0;
    for (const double v : values) total += v;
    const double mean = total / static_cast<double>(values.size());
    for (const double v : values) squares += (v - mean) * (v - mean);
    freedom += static_cast<double>(values.size() - 1);
    sum += total;
    count += static_cast<double>(values.size());
  }
  void merge(const WithinGroups& other) {
    squares += other.squares;
    freedom += other.freedom;
    sum += other.sum;
    count += other.count;
  }
  [[nodiscard]] double variance() const { return freedom > 0.0 ? squares / freedom : kNoFigure; }
  [[nodiscard]] double std_dev() const { return std::sqrt(variance()); }
  [[nodiscard]] double variance_over_mean() const { return variance() * count / sum; }
};

/// Correlation of a series with itself at one lag, about the mean of each series.
struct LagCorrelation {
  double products = 0.0, pairs = 0.0, squares = 0.0, count = 0.0;
  /// `values[i]` is not a number where there is no value at that step.
  void add_series(const std::vector<double>& values, std::size_t lag) {
    double sum = 0.0, n = 0.0;
    for (const double v : values) {
      if (std::isnan(v)) continue;
      sum += v;
      n += 1.0;
    }
    if (n < 2.0) return;
    const double mean = sum / n;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isnan(values[i])) continue;
      squares += (values[i] - mean) * (values[i] - mean);
      count += 1.0;
      if (i + lag >= values.size() || std::isnan(values[i + lag])) continue;
      products += (values[i] - mean) * (values[i + lag] - mean);
      pairs += 1.0;
    }
  }
  void merge(const LagCorrelation& other) {
    products += other.products;
    pairs += other.pairs;
    squares += other.squares;
    count += other.count;
  }
  [[nodiscard]] double value() const {
    return pairs > 0.0 && squares > 0.0 ? (products / pairs) / (squares / count) : kNoFigure;
  }
};

/// Probability that a value of `first` exceeds one of `second`, ties by half (area under the ROC curve).
[[nodiscard]] inline double chance_that_first_exceeds(const std::vector<float>& first, std::vector<float> second) {
  if (first.empty() || second.empty()) return kNoFigure;
  std::sort(second.begin(), second.end());
  double sum = 0.0;
  for (const float v : first) {
    const auto [low, high] = std::equal_range(second.begin(), second.end(), v);
    sum += static_cast<double>(low - second.begin()) + 0.5 * static_cast<double>(high - low);
  }
  return sum / (static_cast<double>(first.size()) * static_cast<double>(second.size()));
}

}  // namespace boresight::bench::realism
