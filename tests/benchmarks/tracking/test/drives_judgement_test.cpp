// The judgement of drives at thresholds, on hand-made lists.
#include <random>

#include "services/simulator/judge/track_judge.hpp"
#include "tests/benchmarks/tracking/drives/judge/judgement.hpp"
#include "tests/benchmarks/tracking/test/drives_scenes.hpp"

namespace boresight::bench::tracking {
namespace {

using made::car;
using made::scene;
using made::track;

Judgement judged(const std::vector<Scene>& scenes, float least_score) {
  ScoredDrive drive;
  for (const Scene& each : scenes) drive.add(each);
  return judge_drive(drive, Rule{least_score, false});
}

TEST(DrivesJudgement, CountsTracksFromTheThresholdOn) {
  const std::vector<Scene> scenes = {scene(0.0, {track(1, 20.0, 0.0, 0.9)}, {car(1, 20.0)}),
                                     scene(0.1, {track(1, 20.0, 0.0, 0.4)}, {car(1, 20.0)})};
  EXPECT_DOUBLE_EQ(judged(scenes, 0.4F).objects.at(0).share(), 1.0);
  EXPECT_DOUBLE_EQ(judged(scenes, 0.5F).objects.at(0).share(), 0.5);
  EXPECT_DOUBLE_EQ(judged(scenes, 0.95F).objects.at(0).share(), 0.0);
}

TEST(DrivesJudgement, AssignsTheNearestOfTheTracksThatCount) {
  // The nearer track is less sure: without it, the other one takes the object.
  const std::vector<Scene> scenes = {scene(0.0, {track(1, 20.0, 0.2, 0.3), track(2, 20.0, 3.0, 0.8)}, {car(1, 20.0)})};
  const Judgement all = judged(scenes, 0.0F);
  EXPECT_DOUBLE_EQ(all.objects.at(0).lists_tracked, 1.0);
  EXPECT_NEAR(all.objects.at(0).near.across_m2, 0.04, 1e-6);
  EXPECT_DOUBLE_EQ(all.lists.duplicates, 1.0);
  const Judgement sure = judged(scenes, 0.5F);
  EXPECT_DOUBLE_EQ(sure.objects.at(0).lists_tracked, 1.0);
  EXPECT_NEAR(sure.objects.at(0).near.across_m2, 9.0, 1e-6);
  EXPECT_DOUBLE_EQ(sure.lists.duplicates, 0.0);
}

TEST(DrivesJudgement, ATrackServesOneObject) {
  const Judgement one = judged({scene(0.0, {track(1, 22.5, 0.0, 1.0)}, {car(1, 20.0), car(2, 26.0)})}, 0.0F);
  EXPECT_DOUBLE_EQ(one.objects.at(0).lists_tracked, 1.0) << "0.5 m from the box";
  EXPECT_DOUBLE_EQ(one.objects.at(1).lists_tracked, 0.0) << "1.5 m from the box";
}

TEST(DrivesJudgement, ATrackInABoxBelongsToThatObjectOnly) {
  const Judgement both = judged(
      {scene(0.0, {track(1, 20.0, 0.0, 1.0), track(2, 20.5, 0.9, 1.0)}, {car(1, 20.0), car(2, 20.0, 2.5)})}, 0.0F);
  EXPECT_DOUBLE_EQ(both.objects.at(1).lists_tracked, 0.0);
  EXPECT_DOUBLE_EQ(both.lists.duplicates, 1.0);
}

TEST(DrivesJudgement, HiddenAndParkedObjectsAreNotAskedFor) {
  judge::TrueObject hidden = car(1, 20.0), parked = car(2, 40.0);
  hidden.in_view = false;
  parked.parked = true;
  ListedTrack stationary = track(2, 40.0, 0.0, 1.0);
  stationary.movement = MovementState::kStationary;
  const Judgement judgement =
      judged({scene(0.0, {track(1, 20.0, 0.0, 1.0), stationary, track(3, 40.0, 0.5, 1.0)}, {hidden, parked})}, 0.0F);
  for (const ObjectTally& object : judgement.objects) EXPECT_DOUBLE_EQ(object.lists_in_view, 0.0);
  EXPECT_DOUBLE_EQ(judgement.lists.at_an_object, 2.0);
  EXPECT_DOUBLE_EQ(judgement.lists.false_tracks, 1.0) << "a parked car does not move";
  EXPECT_DOUBLE_EQ(judgement.lists.duplicates, 0.0);
}

TEST(DrivesJudgement, FalseTracksBeyondTheJudgedRangeDoNotCount) {
  const Judgement judgement = judged({scene(0.0, {track(1, 50.0, 0.0, 0.7), track(2, 120.0, 0.0, 0.7)}, {})}, 0.5F);
  EXPECT_DOUBLE_EQ(judgement.lists.false_tracks, 1.0);
  EXPECT_DOUBLE_EQ(judgement.lists.lists, 1.0);
}

TEST(DrivesJudgement, ErrorsAreThoseOfTheAssignedTrack) {
  ListedTrack turned = track(1, 21.0, 2.4, 1.0);
  turned.heading_rad = M_PI - 0.1;
  turned.length_m = 5.0;
  judge::TrueObject stopped = car(2, 60.0);
  stopped.box.velocity_mps.setZero();
  const Judgement judgement = judged({scene(0.0, {turned, track(2, 60.0, 0.0, 1.0)}, {car(1, 20.0), stopped})}, 0.0F);
  const ObjectTally& near = judgement.objects.at(0);
  EXPECT_NEAR(near.near.along_m2, 1.0, 1e-5);
  EXPECT_NEAR(near.near.across_m2, 2.4 * 2.4, 1e-5);
  EXPECT_NEAR(near.near.length_m2, 1.0, 1e-5);
  EXPECT_NEAR(near.near.heading_rad2, (M_PI - 0.1) * (M_PI - 0.1), 1e-5);
  EXPECT_NEAR(near.near.axis_rad2, 0.01, 1e-5);
  EXPECT_DOUBLE_EQ(near.errors_with_covariance, 1.0);
  EXPECT_DOUBLE_EQ(near.errors_inside, 0.0) << "1 + 2.4² > 5.99";
  EXPECT_DOUBLE_EQ(judgement.objects.at(1).near.lists, 0.0) << "60 m away";
  EXPECT_DOUBLE_EQ(judgement.objects.at(1).errors_inside, 1.0);
}

TEST(DrivesJudgement, AMixtureLiesBetweenItsRules) {
  ScoredDrive drive;
  drive.add(scene(0.0, {track(1, 20.0, 0.0, 3.0), track(2, 50.0, 20.0, 3.0)}, {car(1, 20.0)}));
  drive.add(scene(0.1, {track(1, 20.0, 0.0, 4.0)}, {car(1, 20.0)}));
  const Judgement mixed = judge_drive(drive, OperatingPoint{{3.0F, false}, {3.5F, false}, 0.25, 0.0});
  EXPECT_DOUBLE_EQ(mixed.objects.at(0).share(), 0.25 * 1.0 + 0.75 * 0.5);
  EXPECT_DOUBLE_EQ(mixed.lists.false_tracks, 0.25);
}

TEST(DrivesJudgement, ReliabilityHasTheShareAtAnObject) {
  ScoredDrive drive;
  drive.add(
      scene(0.0, {track(1, 20.0, 0.0, 1.0), track(2, 50.0, 20.0, 0.95), track(3, 50.0, 40.0, 0.05)}, {car(1, 20.0)}));
  const Reliability::Bin& last = drive.reliability().bins.back();
  EXPECT_EQ(last.entries, 2u);
  EXPECT_EQ(last.at_an_object, 1u);
  EXPECT_DOUBLE_EQ(last.score_sum, 1.95);
  EXPECT_EQ(drive.reliability().bins.front().entries, 1u);
}

TEST(DrivesJudgement, AgreesWithTheTrackJudge) {
  // The cars are far apart, so that no pair of the list before decides about an assignment.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-4.0, 4.0), share(0.0, 1.0);
  judge::TrackJudge track_judge;
  ScoredDrive drive;
  for (int i = 0; i < 200; ++i) {
    const double t_s = 0.1 * i;
    Scene each = scene(t_s, {}, {car(1, 20.0), car(2, -40.0, 10.0), car(3, 0.0, -130.0)});
    each.objects[1].in_view = share(random) < 0.7;
    for (std::size_t o = 0; o < each.objects.size(); ++o) {
      if (share(random) < 0.3) continue;
      const Eigen::Vector2d place = each.objects[o].box.position_m;
      each.tracks.push_back(track(static_cast<std::uint32_t>(o + 1), place.x() + anywhere(random),
                                  place.y() + anywhere(random), share(random)));
      each.tracks.back().confirmed = each.tracks.back().score >= 0.4;
    }
    const std::vector<judge::ScoredTrack> list(each.tracks.begin(), each.tracks.end());
    track_judge.add(t_s, list, each.objects);
    drive.add(each);
  }
  track_judge.finish();
  judge::FigureList figures;
  track_judge.write(figures);
  const Judgement judgement = judge_drive(drive, Rule{0.4F, false});
  ObjectTally all;
  for (const ObjectTally& object : judgement.objects) all.add(object, 1.0);
  EXPECT_DOUBLE_EQ(all.share(), figures.value("tracks.all.all_ranges.tracked_share"));
  EXPECT_DOUBLE_EQ(all.errors_inside / all.errors_with_covariance,
                   figures.value("tracks.all.all_ranges.inside_95_share"));
  EXPECT_NEAR(std::sqrt(all.near.along_m2 / all.near.lists), figures.value("tracks.car.all_ranges.along_rms_m"), 1e-5);
  EXPECT_NEAR(judge_drive(drive, Rule{-1.0F, true}).lists.false_tracks, judgement.lists.false_tracks, 1e-12);
}

}  // namespace
}  // namespace boresight::bench::tracking
