#include "tests/benchmarks/tracking/drives/judge/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace boresight::bench::tracking {

OperatingPoint operating_point(std::vector<float> false_scores, std::size_t lists, double wanted_false_tracks) {
  OperatingPoint point;
  if (lists == 0) return point;
  const double wanted = wanted_false_tracks * static_cast<double>(lists);
  if (static_cast<double>(false_scores.size()) <= wanted) {
    point.false_tracks = static_cast<double>(false_scores.size()) / static_cast<double>(lists);
    return point;
  }
  const auto place = false_scores.begin() + static_cast<std::ptrdiff_t>(wanted);
  std::nth_element(false_scores.begin(), place, false_scores.end(), std::greater<>());
  const float score = *place;
  const auto above = static_cast<double>(
      std::count_if(false_scores.begin(), false_scores.end(), [score](float each) { return each > score; }));
  const auto equal = static_cast<double>(std::count(false_scores.begin(), false_scores.end(), score));
  point.lower.least_score = score;
  point.higher.least_score = std::nextafter(score, std::numeric_limits<float>::infinity());
  point.weight_of_lower = (wanted - above) / equal;
  point.false_tracks = wanted_false_tracks;
  return point;
}

}  // namespace boresight::bench::tracking
