// Statistics of samples, and the profile that the tests take their numbers from.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/scenario/read_profile.hpp"

namespace boresight::simulator::returns_test {

inline const radar::Profile& series() {
  static const radar::Profile profile = radar_profile("series_77ghz");
  return profile;
}

inline radar::Draws at_cycle(std::uint32_t cycle, std::uint32_t radar = 1) {
  return {7, radar, cycle};
}

inline double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

inline double std_of(const std::vector<double>& values) {
  const double m = mean(values);
  double sum = 0.0;
  for (const double v : values) sum += (v - m) * (v - m);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

inline double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

template <typename Wanted>
double share_of(const std::vector<double>& values, const Wanted& wanted) {
  return static_cast<double>(std::count_if(values.begin(), values.end(), wanted)) / static_cast<double>(values.size());
}

/// Correlation of values `lag` places apart.
inline double correlation(const std::vector<double>& values, std::size_t lag) {
  const double m = mean(values);
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i + lag < values.size(); ++i) product += (values[i] - m) * (values[i + lag] - m);
  for (const double v : values) square += (v - m) * (v - m);
  return product / square * static_cast<double>(values.size()) / static_cast<double>(values.size() - lag);
}

}  // namespace boresight::simulator::returns_test
