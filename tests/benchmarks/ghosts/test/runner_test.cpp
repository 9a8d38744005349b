#include "tests/benchmarks/ghosts/common/runner.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/summary.hpp"

namespace boresight::bench {
namespace {

TEST(GhostRunner, ADriveIsTheSameWhateverTheThreads) {
  Options one, two;
  one.jobs = 1;
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  const auto a = run_ghost_drives("straight_rail", {methods.data(), 1}, 2, 3.0, one).front();
  const auto b = run_ghost_drives("straight_rail", {methods.data(), 1}, 2, 3.0, two).front();
  // A second method on the same drive does not change the first one's result.
  const auto c = run_ghost_drives("straight_rail", methods, 2, 3.0, one).front();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(a[i].scans, 200u);
    for (const Provenance truth : kOrigins) {
      EXPECT_EQ(a[i].confusion.count(truth) > 0, truth != Provenance::kAmbiguity) << name_of(truth);
      for (const Provenance label : kOrigins) {
        if (truth == Provenance::kAmbiguity) continue;
        EXPECT_EQ(a[i].confusion.percent(truth, label), b[i].confusion.percent(truth, label));
        EXPECT_EQ(a[i].confusion.percent(truth, label), c[i].confusion.percent(truth, label));
      }
    }
    EXPECT_GT(a[i].lost.object_seconds, 0u);
    EXPECT_GT(a[i].reliability.count(), 100u);
  }
  EXPECT_NE(a[0].confusion.count(Provenance::kStationary), a[1].confusion.count(Provenance::kStationary));
  one.first_seed = 2;
  const auto second = run_ghost_drives("straight_rail", {methods.data(), 1}, 1, 3.0, one).front();
  EXPECT_EQ(second[0].confusion.count(Provenance::kStationary), a[1].confusion.count(Provenance::kStationary));
}

TEST(GhostRunner, ARadarProfileReplacesThatOfTheScenario) {
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  const auto outcome = [&](const char* profile) {
    return run_ghost_drive({"straight_rail", profile, 101, 2.0}, {&methods.back(), 1}).front();
  };
  const Outcome scenario = outcome(""), ideal = outcome("ideal"), series = outcome("series_77ghz");
  for (const Provenance truth : kOrigins) {
    EXPECT_EQ(scenario.confusion.count(truth), ideal.confusion.count(truth)) << name_of(truth);
  }
  // Real radars report false moving detections, and more of the stationary world.
  EXPECT_GT(series.confusion.count(Provenance::kClutter), 3 * ideal.confusion.count(Provenance::kClutter));
  EXPECT_GT(series.confusion.count(Provenance::kStationary), ideal.confusion.count(Provenance::kStationary));
  EXPECT_THROW(static_cast<void>(outcome("no_such_profile")), std::invalid_argument);
}

TEST(GhostSummary, TrulyMovingIsTheShareOfRealObjectsAmongDetectionsClassifiedAsMoving) {
  Outcome outcome;
  for (int i = 0; i < 3; ++i) outcome.confusion.add(Provenance::kMoving, Provenance::kMoving, false);
  outcome.confusion.add(Provenance::kMoving, Provenance::kStationary, false);
  outcome.confusion.add(Provenance::kClutter, Provenance::kMoving, false);
  outcome.confusion.add(Provenance::kClutter, Provenance::kMoving, true);
  outcome.confusion.add(Provenance::kGhostType1, Provenance::kGhostType1, false);
  EXPECT_DOUBLE_EQ(percent_truly_moving({outcome}).median, 75.0);
  EXPECT_TRUE(std::isnan(percent_truly_moving({Outcome{}}).median));
}

}  // namespace
}  // namespace boresight::bench
