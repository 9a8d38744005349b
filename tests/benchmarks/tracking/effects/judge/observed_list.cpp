#include "tests/benchmarks/tracking/effects/judge/observed_list.hpp"

#include <algorithm>
#include <limits>

#include "services/common/estimation/unknown.hpp"

namespace boresight::bench::tracking {

namespace {

std::size_t counting(const ObservedList& list, const Rule& rule) {
  return static_cast<std::size_t>(std::count_if(list.tracks.begin(), list.tracks.end(), [&](const ListedTrack& track) {
    return rule.counts(static_cast<float>(track.score), track.confirmed);
  }));
}

bool has_track_at_object(const ObservedList& list, const Rule& rule) {
  return std::any_of(list.tracks.begin(), list.tracks.end(), [&](const ListedTrack& track) {
    return rule.counts(static_cast<float>(track.score), track.confirmed) &&
           std::any_of(list.moving_m.begin(), list.moving_m.end(), [&](const Eigen::Vector2d& detection_m) {
             return (detection_m - track.position_m).norm() <= kAtObject_m;
           });
  });
}

std::vector<ObservedList>::const_iterator first_in_view(const std::vector<ObservedList>& lists) {
  return std::find_if(lists.begin(), lists.end(), [](const ObservedList& list) { return !list.moving_m.empty(); });
}

}  // namespace

double delay_s(const std::vector<ObservedList>& lists, const Rule& rule) {
  const auto first = first_in_view(lists);
  const auto tracked =
      std::find_if(first, lists.end(), [&](const ObservedList& list) { return has_track_at_object(list, rule); });
  return tracked == lists.end() ? std::numeric_limits<double>::infinity() : tracked->t_s - first->t_s;
}

SecondTracks second_tracks(const std::vector<ObservedList>& lists, const Rule& rule) {
  SecondTracks second;
  double present_s = 0.0;
  // A list counts for the time up to the next one.
  for (std::size_t i = 0; i + 1 < lists.size(); ++i) {
    const double step_s = lists[i + 1].t_s - lists[i].t_s;
    const bool has_second = counting(lists[i], rule) > 1;
    present_s = has_second ? present_s + step_s : 0.0;
    second.total_s += has_second ? step_s : 0.0;
    second.longest_s = std::max(second.longest_s, present_s);
  }
  return second;
}

double tracked_percent(const std::vector<ObservedList>& lists, const Rule& rule) {
  const auto first = first_in_view(lists);
  if (first == lists.end()) return kNaN;
  const auto tracked =
      std::count_if(first, lists.end(), [&](const ObservedList& list) { return counting(list, rule) > 0; });
  return 100.0 * static_cast<double>(tracked) / static_cast<double>(lists.end() - first);
}

}  // namespace boresight::bench::tracking
