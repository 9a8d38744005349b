#include <cmath>
#include <string>

#include <fmt/format.h>

#include "tests/benchmarks/common/statistics.hpp"
#include "tests/benchmarks/tracking/drives/report/findings.hpp"

namespace boresight::bench::tracking {

namespace {

/// A class may be worse than the baseline by so many points.
constexpr double kMostWorse_points = 5.0;
constexpr double kLeastInside_percent = 90.0, kMostInside_percent = 98.0;

struct NearBar {
  NearError error;
  const char* what;
  const char* unit;
  double most;
};
constexpr std::array<NearBar, 4> kNearBars = {{{NearError::kLength_m, "length of cars, rms", "m", 1.0},
                                               {NearError::kHeading_deg, "heading of moving cars, rms", "°", 5.0},
                                               {NearError::kAlong_m, "position of cars along, rms", "m", 0.6},
                                               {NearError::kAcross_m, "position of cars across, rms", "m", 0.35}}};

std::string shown_estimate(const Estimate& estimate, const char* unit) {
  return fmt::format("{} ({} … {}) {}, {} objects", fixed(estimate.figure, 2), fixed(estimate.interval.low, 2),
                     fixed(estimate.interval.high, 2), unit, estimate.objects);
}

class Bars {
 public:
  Bars(const Evaluation& evaluation, const TrackerResult& tracker, Findings& findings)
      : evaluation_(evaluation), tracker_(tracker), findings_(findings) {}

  void add_all() {
    if (tracker_.has_true_origins) {
      // What a perfect ghost filter would give is compared with nothing but the time that it takes.
      add_time();
      return;
    }
    for (std::size_t i = 0; i < kFalseTracks.size(); ++i) {
      add_difference(i);
      add_worst_class(i);
    }
    add_existence(kSure, 85.0);
    add_existence(kLikely, 50.0);
    add_ellipses();
    const std::vector<std::size_t> all_cars = objects_of_class(evaluation_, judge::index_of(ObjectClass::kCar));
    if (all_cars.empty()) return;
    for (const NearBar& bar : kNearBars) {
      const Estimate rms = near_rms(tracker_.fixed[kLikely], all_cars, bar.error);
      add(kCars, fmt::format("{}, within {:.0f} m", bar.what, ScoredDrive::kNear_m), rms.figure,
          shown_estimate(rms, bar.unit), fmt::format("≤ {} {}", number(bar.most), bar.unit), rms.figure <= bar.most);
    }
  }

 private:
  /// Without data, NaN, a bar is missed.
  void add(const char* group, std::string what, double figure, std::string shown, std::string limit, bool met) {
    findings_.bars.push_back(
        {group, evaluation_.name, tracker_.name, std::move(what), figure, std::move(shown), std::move(limit), met});
  }

  [[nodiscard]] std::string at_false_tracks(std::size_t i) const {
    return fmt::format("at {} false tracks (reached {}, baseline {})", number(kFalseTracks.at(i)),
                       fixed(tracker_.at_false_tracks.at(i).false_tracks(), 2),
                       fixed(evaluation_.better_baseline.at(i).false_tracks(), 2));
  }

  void add_difference(std::size_t i) {
    const Estimate difference = difference_points(tracker_.at_false_tracks.at(i), evaluation_.better_baseline.at(i),
                                                  objects_of_class(evaluation_, judge::kClasses));
    add(kTracked, "time tracked, difference to the better baseline, all objects, " + at_false_tracks(i),
        difference.interval.low, shown_estimate(difference, "points"), "lower bound > 0 points",
        difference.interval.low > 0.0);
  }

  void add_worst_class(std::size_t i) {
    Estimate worst;
    std::size_t worst_class = 0;
    for (std::size_t c = 1; c < judge::kClasses; ++c) {
      const std::vector<std::size_t> objects = objects_of_class(evaluation_, c);
      if (objects.empty()) continue;
      const Estimate difference =
          difference_points(tracker_.at_false_tracks.at(i), evaluation_.better_baseline.at(i), objects);
      if (worst_class == 0 || difference.figure < worst.figure) worst = difference, worst_class = c;
    }
    if (worst_class == 0) return;
    add(kTracked, fmt::format("the same, worst class ({}), {}", judge::kClassNames.at(worst_class), at_false_tracks(i)),
        worst.figure, shown_estimate(worst, "points"), fmt::format("≥ −{} points", number(kMostWorse_points)),
        worst.figure >= -kMostWorse_points);
  }

  void add_existence(std::size_t rule, double least_percent) {
    const ListTally& lists = tracker_.fixed.at(rule).lists;
    const double entries = lists.at_an_object + lists.false_tracks;
    const double percent = 100.0 * lists.at_an_object / entries;
    add(kExistence, fmt::format("entries with {} that are at an object", kFixedRules.at(rule).name), percent,
        fmt::format("{} %, {} % one-to-one, {:.0f} entries", fixed(percent, 1),
                    fixed(100.0 * lists.assigned / entries, 1), entries),
        fmt::format("≥ {} %", number(least_percent)), percent >= least_percent);
  }

  void add_time() {
    constexpr double kMostP99_ms = 0.5;
    const double p99_ms = quantile(tracker_.step_ms, 0.99);
    add(kTime, "CPU time of the tracker a scan, p99", p99_ms, fmt::format("{} ms", fixed(p99_ms, 2)),
        fmt::format("≤ {} ms", number(kMostP99_ms)), p99_ms <= kMostP99_ms);
  }

  void add_ellipses() {
    for (std::size_t c = 1; c < judge::kClasses; ++c) {
      const std::vector<std::size_t> objects = objects_of_class(evaluation_, c);
      if (objects.empty()) continue;
      const Estimate inside = inside_percent(tracker_.fixed[kLikely], objects);
      add(kEllipse, fmt::format("position errors of a {} inside the 95 % ellipse", judge::kClassNames.at(c)),
          inside.figure, shown_estimate(inside, "%"),
          fmt::format("{}–{} %", number(kLeastInside_percent), number(kMostInside_percent)),
          inside.figure >= kLeastInside_percent && inside.figure <= kMostInside_percent);
    }
  }

  const Evaluation& evaluation_;
  const TrackerResult& tracker_;
  Findings& findings_;
};

}  // namespace

void add_bars(const Evaluation& evaluation, Findings& findings) {
  for (const TrackerResult& tracker : evaluation.trackers) Bars(evaluation, tracker, findings).add_all();
}

}  // namespace boresight::bench::tracking
