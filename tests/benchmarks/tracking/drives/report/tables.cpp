#include <cmath>
#include <string>

#include <fmt/format.h>

#include "tests/benchmarks/common/statistics.hpp"
#include "tests/benchmarks/tracking/drives/report/findings.hpp"

namespace boresight::bench::tracking {

namespace {

std::string interval_text(const Estimate& estimate, int digits) {
  if (std::isnan(estimate.figure)) return fixed(estimate.figure, digits);
  return fmt::format("{} ({} … {})", fixed(estimate.figure, digits), fixed(estimate.interval.low, digits),
                     fixed(estimate.interval.high, digits));
}

/// Columns of the time tracked: all classes, each class, and weighted by lists.
std::vector<std::string> tracked_header() {
  std::vector<std::string> header = {"all %"};
  for (std::size_t i = 1; i < judge::kClasses; ++i) header.push_back(fmt::format("{} %", judge::kClassNames.at(i)));
  header.emplace_back("of lists %");
  return header;
}

void append_tracked(const Evaluation& evaluation, const Outcome& outcome, std::vector<std::string>& row) {
  row.push_back(fixed(tracked_percent(outcome, objects_of_class(evaluation, judge::kClasses)), 1));
  for (std::size_t i = 1; i < judge::kClasses; ++i) {
    row.push_back(fixed(tracked_percent(outcome, objects_of_class(evaluation, i)), 1));
  }
  row.push_back(fixed(tracked_percent_of_lists(outcome), 1));
}

Table new_table(const Evaluation& evaluation, const char* group, const std::string& caption,
                std::vector<std::string> header) {
  return {std::string(group) + "_" + evaluation.name,
          fmt::format("[{}] {}", evaluation.name, caption),
          std::move(header),
          {}};
}

template <typename Row>
void for_all(const Evaluation& evaluation, const Row& row) {
  for (const TrackerResult& tracker : evaluation.trackers) row(tracker);
  for (const TrackerResult& baseline : evaluation.baselines) row(baseline);
}

/// At which errors are judged: tracks that are more likely than not, or the baseline's confirmed ones.
const Outcome& outcome_of_errors(const TrackerResult& result) {
  return result.fixed.at(result.is_baseline ? kConfirmed : kLikely);
}

Table equal_false_tracks(const Evaluation& evaluation) {
  std::vector<std::string> header = {"tracker", "false tracks", "reached", "duplicates", "score"};
  for (std::string& name : tracked_header()) header.push_back(std::move(name));
  Table table = new_table(evaluation, kTracked,
                          fmt::format("time tracked at equal numbers of false tracks at a time; {} drives, {} objects",
                                      evaluation.drives, evaluation.objects.size()),
                          std::move(header));
  for (std::size_t i = 0; i < kFalseTracks.size(); ++i) {
    for_all(evaluation, [&](const TrackerResult& result) {
      const Outcome& outcome = result.at_false_tracks.at(i);
      table.rows.push_back({result.name, number(kFalseTracks.at(i)), fixed(outcome.false_tracks(), 2),
                            fixed(outcome.duplicates(), 2), outcome.rule});
      append_tracked(evaluation, outcome, table.rows.back());
    });
  }
  return table;
}

Table curve(const Evaluation& evaluation) {
  Table table = new_table(evaluation, kTracked,
                          "time tracked at each tracker's own thresholds (95 % interval of a bootstrap over objects)",
                          {"tracker", "false tracks", "reached", "tracked %"});
  const std::vector<std::size_t> objects = objects_of_class(evaluation, judge::kClasses);
  for_all(evaluation, [&](const TrackerResult& result) {
    for (std::size_t i = 0; i < kCurveFalseTracks.size(); ++i) {
      const Outcome& outcome = result.curve.at(i);
      table.rows.push_back({result.name, number(kCurveFalseTracks.at(i)), fixed(outcome.false_tracks(), 3),
                            interval_text(tracked_estimate(outcome, objects), 1)});
    }
  });
  return table;
}

Table differences(const Evaluation& evaluation) {
  Table table =
      new_table(evaluation, kTracked,
                "difference to the better baseline, points (95 % interval of a paired bootstrap over objects)",
                {"tracker", "false tracks", "class", "objects", "tracker %", "baseline %", "difference", "baseline"});
  for (const TrackerResult& tracker : evaluation.trackers) {
    for (std::size_t i = 0; i < kFalseTracks.size(); ++i) {
      const Outcome& own = tracker.at_false_tracks.at(i);
      const Outcome& baseline = evaluation.better_baseline.at(i);
      for (std::size_t c = 0; c < judge::kClasses; ++c) {
        const std::size_t object_class = c == 0 ? judge::kClasses : c;  // all first; unknown has no row
        const std::vector<std::size_t> objects = objects_of_class(evaluation, object_class);
        if (objects.empty()) continue;
        table.rows.push_back({tracker.name, number(kFalseTracks.at(i)),
                              c == 0 ? "all" : std::string(judge::kClassNames.at(c)), std::to_string(objects.size()),
                              fixed(tracked_percent(own, objects), 1), fixed(tracked_percent(baseline, objects), 1),
                              interval_text(difference_points(own, baseline, objects), 1), baseline.rule});
      }
    }
  }
  return table;
}

Table fixed_rules(const Evaluation& evaluation) {
  std::vector<std::string> header = {"tracker", "tracks", "false tracks", "duplicates"};
  for (std::string& name : tracked_header()) header.push_back(std::move(name));
  Table table = new_table(evaluation, kTracked,
                          "false tracks at a time and time tracked without knowledge of the truth", std::move(header));
  for_all(evaluation, [&](const TrackerResult& result) {
    for (const Outcome& outcome : result.fixed) {
      if (outcome.objects.empty()) continue;
      table.rows.push_back(
          {result.name, outcome.rule, fixed(outcome.false_tracks(), 2), fixed(outcome.duplicates(), 2)});
      append_tracked(evaluation, outcome, table.rows.back());
    }
  });
  return table;
}

Table reliability_of(const Evaluation& evaluation, const TrackerResult& tracker) {
  Table table = new_table(evaluation, kExistence, tracker.name + ": existence beside the share of entries at an object",
                          {"existence", "entries", "mean existence", "at an object %"});
  constexpr double kWidth = 1.0 / static_cast<double>(Reliability::kBins);
  for (std::size_t i = 0; i < Reliability::kBins; ++i) {
    const Reliability::Bin& bin = tracker.reliability.bins.at(i);
    const auto entries = static_cast<double>(bin.entries);
    const double low = kWidth * static_cast<double>(i);
    table.rows.push_back({fmt::format("{:.1f} … {:.1f}", low, low + kWidth), std::to_string(bin.entries),
                          fixed(bin.score_sum / entries, 3),
                          fixed(100.0 * static_cast<double>(bin.at_an_object) / entries, 1)});
  }
  return table;
}

Table ellipses(const Evaluation& evaluation) {
  Table table = new_table(evaluation, kEllipse,
                          "share of position errors inside the stated 95 % ellipse (95 % interval of a bootstrap over "
                          "objects); tracks with existence ≥ 0.5, of baselines the confirmed ones",
                          {"tracker", "class", "objects", "inside %"});
  for_all(evaluation, [&](const TrackerResult& result) {
    for (std::size_t c = 1; c < judge::kClasses; ++c) {
      const std::vector<std::size_t> objects = objects_of_class(evaluation, c);
      if (objects.empty()) continue;
      const Estimate inside = inside_percent(outcome_of_errors(result), objects);
      table.rows.push_back({result.name, std::string(judge::kClassNames.at(c)), std::to_string(inside.objects),
                            interval_text(inside, 1)});
    }
  });
  return table;
}

Table cars(const Evaluation& evaluation) {
  Table table = new_table(
      evaluation, kCars,
      "rms errors of cars within 50 m (95 % interval of a bootstrap over objects); tracks with "
      "existence ≥ 0.5, of baselines the confirmed ones",
      {"tracker", "objects", "length m", "heading of moving cars °", "axis of the box °", "along m", "across m"});
  const std::vector<std::size_t> objects = objects_of_class(evaluation, judge::index_of(ObjectClass::kCar));
  for_all(evaluation, [&](const TrackerResult& result) {
    const auto rms = [&](NearError error) { return near_rms(outcome_of_errors(result), objects, error); };
    table.rows.push_back({result.name, std::to_string(rms(NearError::kLength_m).objects),
                          interval_text(rms(NearError::kLength_m), 2), interval_text(rms(NearError::kHeading_deg), 1),
                          interval_text(rms(NearError::kAxis_deg), 1), interval_text(rms(NearError::kAlong_m), 2),
                          interval_text(rms(NearError::kAcross_m), 2)});
  });
  return table;
}

Table times(const Evaluation& evaluation) {
  Table table = new_table(
      evaluation, kTime,
      "CPU time of the tracker stage, ms per scan: median and largest of the drives' means, then of all scans",
      {"tracker", "median", "largest", "mean", "p99"});
  for (const TrackerResult& tracker : evaluation.trackers) {
    std::vector<double> known;
    for (const double time : tracker.ms_per_scan) {
      if (!std::isnan(time)) known.push_back(time);
    }
    if (known.empty()) continue;
    table.rows.push_back({tracker.name, fixed(median(known), 3), fixed(quantile(known, 1.0), 3),
                          fixed(mean(tracker.step_ms), 3), fixed(quantile(tracker.step_ms, 0.99), 3)});
  }
  return table;
}

}  // namespace

void add_tables(const Evaluation& evaluation, Findings& findings) {
  findings.tables.push_back({kTracked, equal_false_tracks(evaluation)});
  findings.tables.push_back({kTracked, curve(evaluation)});
  findings.tables.push_back({kTracked, differences(evaluation)});
  findings.tables.push_back({kTracked, fixed_rules(evaluation)});
  for (const TrackerResult& tracker : evaluation.trackers) {
    findings.tables.push_back({kExistence, reliability_of(evaluation, tracker)});
  }
  findings.tables.push_back({kEllipse, ellipses(evaluation)});
  findings.tables.push_back({kCars, cars(evaluation)});
  findings.tables.push_back({kTime, times(evaluation)});
}

}  // namespace boresight::bench::tracking
