#include "tests/benchmarks/realism/statistics/body_places.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

namespace {

constexpr std::size_t kLeastShown = 3;  // detections in a scan that show a length

double extent(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

}  // namespace

void BodyPlaces::add(const ObservedScan& scan) {
  for (const ObservedObject& object : scan.objects) {
    Figures& figures = figures_[static_cast<std::size_t>(object.user)];
    std::vector<double> along, across, ranges;
    for (const ObservedDetection& d : scan.detections) {
      if (!d.is_direct_of(object.id)) continue;
      const Eigen::Vector2d place = object.in_body(d.position_m);
      along.push_back(place.x());
      across.push_back(place.y());
      ranges.push_back(d.range_m);
      figures.depth_m.add(object.depth_m(d.position_m));
    }
    if (ranges.empty()) continue;
    auto& series = across_m_[{scan.radar, object.id}];
    series.first = object.user;
    series.second.insert(series.second.end(), across.begin(), across.end());
    if (ranges.size() >= kLeastShown) {
      figures.shown_length_m.add(extent(along));
      figures.shown_width_m.add(extent(across));
    }
    const auto nearest = std::min_element(ranges.begin(), ranges.end());
    for (auto range = ranges.begin(); range != ranges.end(); ++range) {
      if (range != nearest) figures.behind_nearest_m.add(*range - *nearest);
    }
  }
}

void BodyPlaces::end_drive() {
  for (const auto& [key, series] : across_m_) {
    const auto& [user, values] = series;
    if (values.size() < 2) continue;
    Figures& figures = figures_[static_cast<std::size_t>(user)];
    figures.across_m.add_group(values);
    double sum = 0.0;
    for (const double v : values) sum += v;
    const double mean = sum / static_cast<double>(values.size());
    for (const double v : values) figures.across_from_mean_m.add(std::abs(v - mean));
  }
  across_m_.clear();
}

void BodyPlaces::merge(const BodyPlaces& other) {
  for (std::size_t u = 0; u < kRoadUsers; ++u) {
    Figures& mine = figures_[u];
    const Figures& its = other.figures_[u];
    mine.depth_m.merge(its.depth_m);
    mine.shown_length_m.merge(its.shown_length_m);
    mine.shown_width_m.merge(its.shown_width_m);
    mine.behind_nearest_m.merge(its.behind_nearest_m);
    mine.across_m.merge(its.across_m);
    mine.across_from_mean_m.merge(its.across_from_mean_m);
  }
}

}  // namespace boresight::bench::realism
