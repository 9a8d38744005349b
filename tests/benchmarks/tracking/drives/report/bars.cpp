#include <cmath>
#include <string>

#include <fmt/format.h>

#include "services/simulator/judge/track_judge.hpp"
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
    if (tracker_.origins == Origins::kNone) return;
    if (tracker_.origins == Origins::kTrue) {
      // What a perfect ghost filter would give is compared with nothing but the time that it takes.
      add_time();
      return;
    }
    for (std::size_t i = 0; i < kFalseTracks.size(); ++i) {
      add_difference(i);
      add_worst_class(i);
    }
    add_false_tracks();
    add_origins();
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

  /// Each drive has one value, so that the interval is over drives.
  void add_drives(std::string what, const std::vector<double>& values, double figure, const Interval& interval,
                  const char* unit, const std::string& limit, bool met) {
    add(kFalse, std::move(what), figure,
        fmt::format("{} ({} … {}){}, {} drives", fixed(figure, 2), fixed(interval.low, 2), fixed(interval.high, 2),
                    unit, values.size()),
        limit, met);
  }

  void add_false_tracks() {
    constexpr double kMostAtATime = 0.1, kLeastClean_percent = 90.0;
    std::vector<double> at_a_time, clean_percent;
    for (const ListTally& lists : tracker_.fixed[kConfirmed].lists_of_drives) {
      at_a_time.push_back(lists.false_tracks / lists.lists);
    }
    for (const std::size_t tracks : tracker_.long_false_tracks) clean_percent.push_back(tracks == 0 ? 100.0 : 0.0);
    const Interval of_median = median_interval(at_a_time);
    add_drives("confirmed false tracks at a time, median of the drives", at_a_time, median(at_a_time), of_median, "",
               fmt::format("≤ {}", number(kMostAtATime)), of_median.low <= kMostAtATime);
    const Interval of_clean = bootstrap(clean_percent.size(), [&](const std::vector<std::size_t>& picks) {
      double sum = 0.0;
      for (const std::size_t pick : picks) sum += clean_percent[pick];
      return sum / static_cast<double>(picks.size());
    });
    add_drives(fmt::format("drives without a confirmed false track of {} s or more",
                           number(judge::TrackJudge::kLongFalseLife_s)),
               clean_percent, mean(clean_percent), of_clean, " %", fmt::format("≥ {} %", number(kLeastClean_percent)),
               of_clean.high >= kLeastClean_percent);
  }

  /// Of the drives where a tracker has more than one false track at a time, or of the others.
  [[nodiscard]] std::vector<std::size_t> objects_of_drives(const TrackerResult& tracker, bool are_busy) const {
    std::vector<std::size_t> objects;
    for (std::size_t i = 0; i < evaluation_.objects.size(); ++i) {
      const ListTally& lists = tracker.fixed[kLikely].lists_of_drives.at(evaluation_.objects[i].drive);
      if ((lists.false_tracks / lists.lists > 1.0) == are_busy) objects.push_back(i);
    }
    return objects;
  }

  void add_origins() {
    constexpr std::size_t kAtOne = 4;  // of kCurveFalseTracks
    static_assert(kCurveFalseTracks[kAtOne] == 1.0);
    const auto add_against = [&](const char* what, const TrackerResult& other, const std::vector<std::size_t>& objects,
                                 double least_points) {
      if (objects.empty()) return;
      const Estimate difference = difference_points(tracker_.curve[kAtOne], other.curve[kAtOne], objects);
      add(kFalse, fmt::format("time tracked at 1 false track at a time, difference to {}", what), difference.figure,
          shown_estimate(difference, "points"), fmt::format("≥ {} points", number(least_points)),
          difference.interval.high >= least_points);
    };
    for (const TrackerResult& other : evaluation_.trackers) {
      if (other.origins == Origins::kTrue) {
        add_against("true origins", other, objects_of_class(evaluation_, judge::kClasses), -3.0);
      }
      if (other.origins == Origins::kNone) {
        add_against("no ghost filter, where that has > 1 false track", other, objects_of_drives(other, true), 10.0);
        add_against("no ghost filter, other drives", other, objects_of_drives(other, false), -2.0);
      }
    }
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
