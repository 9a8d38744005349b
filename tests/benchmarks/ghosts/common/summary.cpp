#include "tests/benchmarks/ghosts/common/summary.hpp"

#include <algorithm>
#include <utility>

#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

namespace {

template <typename Of>
Percent over_seeds(const std::vector<Outcome>& outcomes, Provenance truth, Of&& of) {
  std::vector<double> values;
  for (const Outcome& o : outcomes) {
    if (o.confusion.count(truth) > 0) values.push_back(of(o.confusion));
  }
  return {median(values), quantile(values, 0.0)};
}

template <typename Of>
Percent shares(const std::vector<Outcome>& outcomes, Of&& of) {
  std::vector<double> values;
  for (const Outcome& o : outcomes) {
    const auto [some, all] = of(o.type1);
    if (all > 0) values.push_back(100.0 * static_cast<double>(some) / static_cast<double>(all));
  }
  return {median(values), quantile(values, 0.0)};
}

}  // namespace

Percent percent_classified(const std::vector<Outcome>& outcomes, Provenance truth, Provenance label) {
  return over_seeds(outcomes, truth, [&](const Confusion& c) { return c.percent(truth, label); });
}

Percent percent_classified_ghost(const std::vector<Outcome>& outcomes, Provenance truth) {
  return over_seeds(outcomes, truth, [&](const Confusion& c) { return c.percent_ghost(truth); });
}

Percent percent_not_moving(const std::vector<Outcome>& outcomes, Provenance truth) {
  return over_seeds(outcomes, truth, [&](const Confusion& c) { return 100.0 - c.percent(truth, Provenance::kMoving); });
}

Percent percent_truly_moving(const std::vector<Outcome>& outcomes) {
  std::vector<double> values;
  for (const Outcome& o : outcomes) {
    const auto right = static_cast<double>(o.confusion.count(Provenance::kMoving, Provenance::kMoving));
    double all = 0.0;
    for (const Provenance truth : kOrigins) all += static_cast<double>(o.confusion.count(truth, Provenance::kMoving));
    if (all > 0.0) values.push_back(100.0 * right / all);
  }
  return {median(values), quantile(values, 0.0)};
}

Percent percent_rejected(const std::vector<Outcome>& outcomes, Provenance truth) {
  return over_seeds(outcomes, truth, [&](const Confusion& c) {
    const auto rejected = static_cast<double>(c.rejected(truth));
    return 100.0 * rejected / (rejected + static_cast<double>(c.count(truth)));
  });
}

Percent percent_apart(const std::vector<Outcome>& outcomes) {
  return shares(outcomes, [](const ApartGhosts& g) { return std::pair{g.apart, g.all}; });
}

Percent percent_apart_classified_ghost(const std::vector<Outcome>& outcomes) {
  return shares(outcomes, [](const ApartGhosts& g) { return std::pair{g.apart_classified_ghost, g.apart}; });
}

double median_count(const std::vector<Outcome>& outcomes, Provenance truth) {
  std::vector<double> values;
  for (const Outcome& o : outcomes) {
    values.push_back(static_cast<double>(o.confusion.count(truth) + o.confusion.rejected(truth)));
  }
  return median(values);
}

TrackFaults& TrackFaults::operator+=(const TrackFaults& other) {
  ghost_tracks += other.ghost_tracks;
  longest_ghost_track_scans = std::max(longest_ghost_track_scans, other.longest_ghost_track_scans);
  other_tracks += other.other_tracks;
  object_seconds += other.object_seconds;
  lost_seconds += other.lost_seconds;
  lost_though_correct_seconds += other.lost_though_correct_seconds;
  gained_seconds += other.gained_seconds;
  objects += other.objects;
  lost_objects += other.lost_objects;
  lasting_ghost_tracks += other.lasting_ghost_tracks;
  lost_by_chance += other.lost_by_chance;
  return *this;
}

TrackFaults track_faults(const std::vector<Outcome>& outcomes) {
  TrackFaults sum;
  for (const Outcome& o : outcomes) {
    const auto lasting = std::count_if(o.long_ghost_tracks.begin(), o.long_ghost_tracks.end(), [](const GhostTrack& t) {
      return t.until_s - t.since_s >= TrackFaults::kFiveSteps_s;
    });
    sum += {.ghost_tracks = o.long_ghost_tracks.size(),
            .longest_ghost_track_scans = o.longest_ghost_track_scans,
            .other_tracks = o.long_other_tracks,
            .object_seconds = o.lost.object_seconds,
            .lost_seconds = o.lost.lost.size(),
            .lost_though_correct_seconds = o.lost.lost_though_correct,
            .gained_seconds = o.lost.gained,
            .objects = o.lost.of_object.size(),
            .lost_objects = o.lost.mostly_lost(),
            .lasting_ghost_tracks = static_cast<std::size_t>(lasting),
            .lost_by_chance = o.lost_by_chance};
  }
  return sum;
}

}  // namespace boresight::bench
