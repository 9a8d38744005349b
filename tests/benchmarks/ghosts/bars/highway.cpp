// Le Ba Thanh's scene. The published method reaches its published figures, so the scene is not easier than the
// original; the product's own method is better.
#include <algorithm>
#include <vector>

#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/curves.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/tables.hpp"

namespace boresight::bench {

namespace {

constexpr const char* kScenario = "highway_multipath";
constexpr double kDuration_s = 11.4;  // 114 steps of 0.1 s

/// Le Ba Thanh's table: number of detections, and percent classified correctly, with a GGIW-PMBM tracker.
struct Published {
  Provenance truth;
  double count;
  double right_percent;
};
constexpr Published kPublished[] = {{Provenance::kMoving, 1968.0, 97.71},
                                    {Provenance::kStationary, 27064.0, 92.16},
                                    {Provenance::kGhostType1, 833.0, 74.35},
                                    {Provenance::kGhostType2, 3153.0, 93.82}};
constexpr double kPublishedClutter = 130.0, kPublishedClutterNotMoving = 75.38;

void judge_counts(const std::vector<Outcome>& outcomes, const std::string& how, Report& report) {
  const auto judge = [&](Provenance truth, double published) {
    const double count = median_count(outcomes, truth);
    const double rejected = 0.01 * percent_rejected(outcomes, truth).median * count;
    report.within("scene", "detections: " + std::string(name_of(truth)), count, 0.8 * published, 1.2 * published, "",
                  how + "; Le Ba Thanh 2023: " + fixed(published, 0) +
                      " ± 20 %; rejected by the corrector: " + fixed(rejected, 0));
  };
  for (const Published& p : kPublished) judge(p.truth, p.count);
  judge(Provenance::kClutter, kPublishedClutter);
}

void judge_published(const std::vector<Outcome>& outcomes, const std::string& how, Report& report) {
  for (const Published& p : kPublished) {
    report.within("published", std::string(name_of(p.truth)) + " classified correctly",
                  percent_classified(outcomes, p.truth, p.truth).median, p.right_percent - 5.0,
                  std::min(100.0, p.right_percent + 5.0), "%",
                  how + "; Le Ba Thanh 2023: " + fixed(p.right_percent, 2) + " ± 5");
  }
  report.within("published", "clutter not classified as moving",
                percent_not_moving(outcomes, Provenance::kClutter).median, kPublishedClutterNotMoving - 5.0,
                kPublishedClutterNotMoving + 5.0, "%", how + "; Le Ba Thanh 2023: 75.38 ± 5");
}

void judge_own(const std::vector<Outcome>& outcomes, const std::string& how_many, Report& report) {
  const std::string how = "median over " + how_many;
  const auto right = [&](Provenance truth, double bar) {
    judge_percent("highway", std::string(name_of(truth)) + " classified correctly",
                  percent_classified(outcomes, truth, truth), bar, how, report);
  };
  const auto ghost = [&](Provenance truth, double bar) {
    judge_percent("highway", std::string(name_of(truth)) + " classified as ghost",
                  percent_classified_ghost(outcomes, truth), bar, how, report);
  };
  right(Provenance::kMoving, 99.0);
  right(Provenance::kStationary, 99.0);
  ghost(Provenance::kGhostType1, 95.0);
  right(Provenance::kGhostType1, 90.0);
  ghost(Provenance::kGhostType2, 99.0);
  right(Provenance::kGhostType2, 97.0);
  judge_percent("highway", "clutter not classified as moving", percent_not_moving(outcomes, Provenance::kClutter), 90.0,
                how, report);
  report.beside("highway", "type 1 more than 0.5 m from its object: classified as ghost",
                percent_apart_classified_ghost(outcomes).median, "%",
                how + "; these are " + fixed(percent_apart(outcomes).median, 1) + " % of type 1");
  report.beside("highway", "moving rejected by the corrector", percent_rejected(outcomes, Provenance::kMoving).median,
                "%", how);
  judge_tracks("highway", outcomes, true, how_many, report);
}

void compare(const std::vector<NamedGhostMethod>& methods, const std::vector<std::vector<Outcome>>& outcomes,
             Report& report) {
  const auto add = [&](const std::string& what, double published, double bar, auto&& percent) {
    add_comparison("highway_multipath", what, "Le Ba Thanh 2023", published, report);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      add_comparison("highway_multipath", what, methods[m].name, percent(outcomes[m]), report);
    }
    add_comparison("highway_multipath", what, "bar", bar, report);
  };
  const auto right = [](Provenance truth) {
    return [truth](const std::vector<Outcome>& of) { return percent_classified(of, truth, truth).median; };
  };
  const auto ghost = [](Provenance truth) {
    return [truth](const std::vector<Outcome>& of) { return percent_classified_ghost(of, truth).median; };
  };
  add("moving → moving", 97.71, 99.0, right(Provenance::kMoving));
  add("stationary → stationary", 92.16, 99.0, right(Provenance::kStationary));
  add("type 1 → ghost", 76.27, 95.0, ghost(Provenance::kGhostType1));
  add("type 1 → type 1", 74.35, 90.0, right(Provenance::kGhostType1));
  add("type 2 → ghost", 95.31, 99.0, ghost(Provenance::kGhostType2));
  add("type 2 → type 2", 93.82, 97.0, right(Provenance::kGhostType2));
  add("clutter → not moving", kPublishedClutterNotMoving, 90.0,
      [](const std::vector<Outcome>& of) { return percent_not_moving(of, Provenance::kClutter).median; });
}

}  // namespace

void highway(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(20);
  const double duration_s = drive_seconds(options, kDuration_s);
  const std::string how_many = std::to_string(seeds) + " seeds of " + fixed(duration_s, 1) + " s";
  const std::string how = "median over " + how_many;
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  const auto outcomes = run_ghost_drives(kScenario, methods, seeds, duration_s, options);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    report.add(confusion_table("highway_" + methods[m].name,
                               "highway_multipath, " + methods[m].name + ": % of each truth, " + how, outcomes[m]));
  }
  judge_counts(outcomes.front(), how, report);
  judge_published(outcomes.front(), how, report);
  judge_tracks("published", outcomes.front(), false, how_many, report);
  judge_own(outcomes.back(), how_many, report);
  compare(methods, outcomes, report);
  add_reliability("reliability_highway", "highway_multipath", how_many, methods, outcomes, report);
}

}  // namespace boresight::bench
