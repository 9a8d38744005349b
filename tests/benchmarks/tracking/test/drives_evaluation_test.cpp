// Thresholds, the comparison with the baseline, and bars, on hand-made lists.
#include "tests/benchmarks/tracking/drives/judge/estimates.hpp"
#include "tests/benchmarks/tracking/drives/judge/evaluation.hpp"
#include "tests/benchmarks/tracking/drives/report/findings.hpp"
#include "tests/benchmarks/tracking/test/drives_scenes.hpp"

namespace boresight::bench::tracking {
namespace {

using made::car;
using made::scene;
using made::track;

TEST(DrivesThreshold, ReachesTheWantedNumberOfFalseTracks) {
  const OperatingPoint point = operating_point({0.9F, 0.2F, 0.8F, 0.4F}, 2, 1.0);
  EXPECT_FLOAT_EQ(point.lower.least_score, 0.4F);
  EXPECT_DOUBLE_EQ(point.weight_of_lower, 0.0) << "two false tracks lie above";
  EXPECT_GT(point.higher.least_score, 0.4F);
  EXPECT_DOUBLE_EQ(point.false_tracks, 1.0);
}

TEST(DrivesThreshold, MixesTwoThresholdsOfEqualScores) {
  const OperatingPoint point = operating_point({5.0F, 3.0F, 3.0F, 3.0F, 3.0F, 1.0F}, 2, 1.0);
  EXPECT_FLOAT_EQ(point.lower.least_score, 3.0F);
  EXPECT_DOUBLE_EQ(point.weight_of_lower, 0.25) << "one of the four at 3";
}

TEST(DrivesThreshold, CountsEveryTrackIfFalseOnesAreTooFew) {
  const OperatingPoint point = operating_point({0.9F}, 4, 1.0);
  EXPECT_TRUE(point.lower.counts(0.0F, false));
  EXPECT_DOUBLE_EQ(point.weight_of_lower, 1.0);
  EXPECT_DOUBLE_EQ(point.false_tracks, 0.25);
}

/// A drive of 2 s with a car that is tracked with `score` in the first `tracked` of 21 lists, and `false_tracks` false
/// ones in each.
ScoredDrive drive_with(int tracked, double score, int false_tracks, double false_score) {
  ScoredDrive drive;
  for (int i = 0; i <= 20; ++i) {
    Scene each = scene(0.1 * i, {}, {car(1, 20.0)});
    if (i < tracked) each.tracks.push_back(track(1, 20.0, 0.0, score));
    for (int k = 0; k < false_tracks; ++k) {
      each.tracks.push_back(track(100 + static_cast<std::uint32_t>(k), -50.0, 10.0 * k, false_score));
    }
    drive.add(each);
  }
  return drive;
}

Contestant contestant(std::string name, bool is_baseline, std::vector<ScoredDrive> drives) {
  Contestant of;
  of.name = std::move(name);
  of.is_baseline = is_baseline;
  of.ms_per_scan.assign(drives.size(), 0.1);
  of.drives = std::move(drives);
  return of;
}

TEST(DrivesEvaluation, TakesTheBetterBaselineAndNoMoreFalseTracksThanIt) {
  const Evaluation evaluation = evaluate("made", {contestant("product", false, {drive_with(21, 0.3, 4, 0.3)}),
                                                  contestant("worse", true, {drive_with(7, 9.0, 4, 1.0)}),
                                                  contestant("better", true, {drive_with(14, 9.0, 1, 1.0)})});
  const Outcome& baseline = evaluation.better_baseline[1];
  EXPECT_EQ(baseline.rule, "better: all tracks");
  EXPECT_DOUBLE_EQ(baseline.false_tracks(), 1.0) << "it has no more";
  EXPECT_DOUBLE_EQ(evaluation.trackers.at(0).at_false_tracks[1].false_tracks(), 1.0);
  // At one of four false tracks, which score as high as the car, a quarter of the car's lists.
  EXPECT_NEAR(mean_share(evaluation.trackers.at(0).at_false_tracks[1].objects), 0.25, 1e-12);
  EXPECT_NEAR(mean_share(baseline.objects), 14.0 / 21.0, 1e-12);
}

TEST(DrivesEvaluation, CurveIsOfEachTrackerAlone) {
  const Evaluation evaluation = evaluate("made", {contestant("product", false, {drive_with(21, 0.3, 4, 0.3)}),
                                                  contestant("baseline", true, {drive_with(14, 9.0, 1, 1.0)})});
  const TrackerResult& product = evaluation.trackers.at(0);
  EXPECT_DOUBLE_EQ(product.at_false_tracks.back().false_tracks(), 1.0) << "as many as the baseline";
  for (std::size_t i = 0; i < kCurveFalseTracks.size(); ++i) {
    const double most = std::min(4.0, kCurveFalseTracks.at(i));
    EXPECT_NEAR(product.curve.at(i).false_tracks(), most, 1e-9);
    EXPECT_NEAR(tracked_estimate(product.curve.at(i), {0}).figure, 100.0 * most / 4.0, 1e-9);
  }
}

TEST(DrivesEvaluation, ObjectsThatAreSeenForTooShortATimeAreNotJudged) {
  ScoredDrive drive;
  for (int i = 0; i < 9; ++i) drive.add(scene(0.1 * i, {}, {car(1, 20.0)}));
  EXPECT_TRUE(evaluate("made", {contestant("product", false, {drive})}).objects.empty());
}

TEST(DrivesEvaluation, PoolsObjectsOfProfilesAtTheirOwnThresholds) {
  Evaluation pooled;
  for (const double score : {0.9, 0.2}) {
    pooled.append(evaluate("made", {contestant("product", false, {drive_with(21, score, 2, score - 0.1)}),
                                    contestant("baseline", true, {drive_with(14, 9.0, 1, 1.0)})}));
  }
  EXPECT_EQ(pooled.drives, 2u);
  ASSERT_EQ(pooled.objects.size(), 2u);
  EXPECT_EQ(pooled.objects.at(1).drive, 1u);
  const Outcome& own = pooled.trackers.at(0).at_false_tracks[0];
  EXPECT_EQ(own.rule, "by profile");
  EXPECT_DOUBLE_EQ(own.false_tracks(), 1.0);
  EXPECT_DOUBLE_EQ(mean_share(own.objects), 1.0);
}

TEST(DrivesEstimates, TheDifferenceIsPairedByObject) {
  // Both lose the same objects, so that the difference is 0.1 of each object's lists, without scatter.
  Outcome own, baseline;
  Evaluation evaluation;
  for (std::size_t i = 0; i < 20; ++i) {
    evaluation.objects.push_back({i, 1, i < 5 ? ObjectClass::kTruck : ObjectClass::kVan});
    own.objects.push_back({100.0, i % 2 == 0 ? 90.0 : 30.0, 0.0, 0.0, {}});
    baseline.objects.push_back({100.0, i % 2 == 0 ? 80.0 : 20.0, 0.0, 0.0, {}});
  }
  const std::vector<std::size_t> all = objects_of_class(evaluation, judge::kClasses);
  ASSERT_EQ(all.size(), 20u);
  EXPECT_EQ(objects_of_class(evaluation, judge::index_of(ObjectClass::kCar)).size(), 15u) << "vans are cars";
  const Estimate difference = difference_points(own, baseline, all);
  EXPECT_NEAR(difference.figure, 10.0, 1e-9);
  EXPECT_NEAR(difference.interval.low, 10.0, 1e-9);
  EXPECT_NEAR(difference.interval.high, 10.0, 1e-9);
}

TEST(DrivesEstimates, RatiosAreWeightedByLists) {
  Outcome outcome;
  outcome.objects.push_back({10.0, 10.0, 10.0, 10.0, {4.0, 16.0, 0.0, 0.0, 0.0, 0.0, 0.0}});
  outcome.objects.push_back({30.0, 30.0, 30.0, 15.0, {4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}});
  outcome.objects.push_back({5.0, 0.0, 0.0, 0.0, {}});
  EXPECT_DOUBLE_EQ(inside_percent(outcome, {0, 1, 2}).figure, 62.5);
  EXPECT_EQ(inside_percent(outcome, {0, 1, 2}).objects, 2u);
  EXPECT_DOUBLE_EQ(near_rms(outcome, {0, 1, 2}, NearError::kAlong_m).figure, std::sqrt(2.0));
  EXPECT_TRUE(std::isnan(near_rms(outcome, {2}, NearError::kAlong_m).figure));
  EXPECT_DOUBLE_EQ(tracked_percent_of_lists(outcome), 100.0 * 40.0 / 45.0);
}

TEST(DrivesBars, AreMetByAPerfectTrackerAndMissedWithoutData) {
  const auto bars_of = [](const ScoredDrive& drive) {
    Findings findings;
    add_bars(evaluate("made", {contestant("product", false, {drive}),
                               contestant("baseline", true, {drive_with(14, 9.0, 0, 0.0)})}),
             findings);
    return findings.bars;
  };
  for (const BarLine& bar : bars_of(drive_with(21, 0.95, 0, 0.0))) {
    // Every error is 0, so that more of them lie inside the ellipse than stated.
    EXPECT_EQ(bar.met, bar.group != kEllipse) << bar.what;
  }
  for (const BarLine& bar : bars_of(drive_with(0, 0.95, 0, 0.0))) {
    EXPECT_EQ(bar.met, bar.group == kFalse) << bar.what << ": no track is no false track";
  }
}

TEST(DrivesBars, FalseTracksAreCountedByDrive) {
  // In two of five drives a false track is confirmed for 2 s.
  std::vector<ScoredDrive> drives;
  for (int d = 0; d < 5; ++d) drives.push_back(drive_with(21, 0.9, 0, 0.0));
  for (int d = 0; d < 2; ++d) {
    for (int i = 0; i <= 20; ++i) {
      ListedTrack false_track = track(9, -50.0, 0.0, 0.9);
      false_track.confirmed = true;
      drives[static_cast<std::size_t>(d)].add(scene(10.0 + 0.1 * i, {false_track}, {}));
    }
  }
  EXPECT_EQ(drives[0].long_false_tracks(), 1u);
  EXPECT_EQ(drives[4].long_false_tracks(), 0u);
  Findings findings;
  add_bars(evaluate("made", {contestant("product", false, drives)}), findings);
  std::vector<double> figures;
  for (const BarLine& bar : findings.bars) {
    if (bar.group == kFalse) figures.push_back(bar.figure);
  }
  EXPECT_EQ(figures, (std::vector<double>{0.0, 60.0}));
}

TEST(DrivesBars, TheFilterIsComparedWithNoneInBusyAndInQuietDrives) {
  // Without the filter, the first drive has two false tracks that look better than the car; the second has none.
  Contestant none = contestant("unfiltered", false, {drive_with(21, 0.6, 2, 0.9), drive_with(21, 0.6, 0, 0.0)});
  none.origins = Origins::kNone;
  Contestant truth = contestant("perfect", false, {drive_with(21, 0.9, 0, 0.0), drive_with(21, 0.9, 0, 0.0)});
  truth.origins = Origins::kTrue;
  const Contestant product = contestant("product", false, {drive_with(21, 0.9, 0, 0.0), drive_with(20, 0.9, 0, 0.0)});
  Findings findings;
  add_bars(evaluate("made", {product, truth, none}), findings);
  std::vector<const BarLine*> lines;
  for (const BarLine& bar : findings.bars) {
    if (bar.group == kFalse && bar.what.starts_with("time tracked")) lines.push_back(&bar);
  }
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_NEAR(lines[0]->figure, -50.0 / 21.0, 1e-9) << "true origins";
  EXPECT_NEAR(lines[1]->figure, 0.0, 1e-9) << "busy: one false track in each list of both drives, with the car at 0.6";
  EXPECT_NEAR(lines[2]->figure, -100.0 / 21.0, 1e-9);
  EXPECT_FALSE(lines[2]->met);
}

}  // namespace
}  // namespace boresight::bench::tracking
