// Figures of hand-made detections.
#include "tests/benchmarks/ghosts/drives/judge/figures.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::bench::ghosts_drives {
namespace {

JudgedDetection detection(Provenance truth, float p, float base_rate = 0.5F) {
  JudgedDetection d;
  d.truth = truth;
  d.is_real = truth == Provenance::kMoving;
  d.base_rate = base_rate;
  d.p_moving.fill(p);
  return d;
}

TEST(Figures, BrierRatioIsOverTheBaseRateOfAllDrivesTogether) {
  DriveResult first, second;
  first.detections = {detection(Provenance::kMoving, 0.9F)};         // 0.01 beside 0.25
  second.detections = {detection(Provenance::kClutter, 0.3F),        // 0.09 beside 0.25
                       detection(Provenance::kMoving, 0.6F, 0.2F)};  // 0.16 beside 0.64
  EXPECT_NEAR(brier_ratio(Lane::kWithout)({&first, &second}), 0.26 / 1.14, 1e-6);
  EXPECT_NEAR(brier_ratio(Lane::kWithout)({&first}), 0.04, 1e-6);
  EXPECT_TRUE(std::isnan(brier_ratio(Lane::kWithout)({})));
  // Each lane has its own probability.
  first.detections[0].p_moving[static_cast<std::size_t>(Lane::kChain)] = 1.0F;
  EXPECT_EQ(brier_ratio(Lane::kChain)({&first}), 0.0);
}

TEST(Figures, EstimatesAreOfAllDrivesAndOfSingleOnes) {
  DriveResult good, poor, empty;
  good.detections = {detection(Provenance::kMoving, 0.9F)};  // 0.01 beside 0.25
  poor.detections = {detection(Provenance::kMoving, 0.4F)};  // 0.36 beside 0.25
  const Estimate e = estimate(brier_ratio(Lane::kWithout), {&good, &poor, &empty});
  EXPECT_NEAR(e.all, 0.37 / 0.5, 1e-6);
  EXPECT_NEAR(e.median, 0.5 * (0.04 + 1.44), 1e-6) << "the drive without detections has no figure";
  EXPECT_NEAR(e.interval.low, 0.04, 1e-6);
  EXPECT_NEAR(e.interval.high, 1.44, 1e-6);
  EXPECT_TRUE(std::isnan(estimate(ambiguous_kept(Lane::kPerfect), {&good, &poor}).interval.low));
}

TEST(Figures, LogarithmicScoreBoundsCertainErrors) {
  DriveResult drive;
  drive.detections = {detection(Provenance::kClutter, 1.0F)};
  EXPECT_NEAR(log_loss_ratio(Lane::kWithout)({&drive}), std::log(1e-4) / std::log(0.5), 1e-4);
}

TEST(Figures, CalibrationErrorIsTheMeanOverTenthsOfTheProbability) {
  DriveResult drive;
  // Four at 0.25, two of them real: error 0.25. Six at 0.95, all real: error 0.05.
  for (int i = 0; i < 4; ++i)
    drive.detections.push_back(detection(i < 2 ? Provenance::kMoving : Provenance::kClutter, 0.25F));
  for (int i = 0; i < 6; ++i) drive.detections.push_back(detection(Provenance::kMoving, 0.95F));
  EXPECT_NEAR(calibration_error(Lane::kWithout)({&drive}), 0.13, 1e-6);
  const std::vector<ReliabilityBin> bins = reliability({&drive}, Lane::kWithout);
  ASSERT_EQ(bins.size(), 10u);
  EXPECT_EQ(bins[2].detections, 4.0);
  EXPECT_EQ(bins[2].real, 2.0);
  EXPECT_NEAR(bins[9].stated, 5.7, 1e-6);
  drive.detections = {detection(Provenance::kMoving, 1.0F)};
  EXPECT_EQ(calibration_error(Lane::kWithout)({&drive}), 0.0) << "1 belongs to the last tenth";
}

TEST(Figures, KnownObjectsAreLostBelowOneHalfAfterOneSecond) {
  DriveResult drive;
  for (const auto& [known_s, p] : {std::pair(2.0F, 0.4F), {2.0F, 0.6F}, {0.5F, 0.1F}, {-1.0F, 0.1F}}) {
    drive.detections.push_back(detection(Provenance::kMoving, p));
    drive.detections.back().known_s = known_s;
  }
  EXPECT_EQ(known_lost(Lane::kPerfect)({&drive}), 0.5);
  EXPECT_TRUE(std::isnan(ambiguous_kept(Lane::kPerfect)({&drive}))) << "no radar with this effect";
  for (JudgedDetection& d : drive.detections) d.is_ambiguous = true;
  EXPECT_NEAR(ambiguous_kept(Lane::kPerfect)({&drive}), 1.0 / 3.0, 1e-12) << "of three known ones";
}

TEST(Figures, RecognisedAreThoseBelowTheProbabilityOfNineInTenRealOnes) {
  DriveResult drive;
  for (int i = 0; i < 10; ++i) {
    drive.detections.push_back(detection(Provenance::kMoving, 0.35F + 0.05F * static_cast<float>(i)));
  }
  // The lowest of ten real ones is lost, so the threshold is 0.4.
  for (const float p : {0.1F, 0.39F, 0.41F}) drive.detections.push_back(detection(Provenance::kGhostType1, p));
  drive.detections.push_back(detection(Provenance::kClutter, 0.9F));
  EXPECT_EQ(recognised_at_90(Lane::kWithout)({&drive}), 0.5);
  EXPECT_NEAR(recognised_at_90(Lane::kWithout, Provenance::kGhostType1)({&drive}), 2.0 / 3.0, 1e-12);
  EXPECT_EQ(recognised_at_90(Lane::kWithout, Provenance::kClutter)({&drive}), 0.0);
  EXPECT_TRUE(std::isnan(recognised_at_90(Lane::kWithout, Provenance::kGhostType2)({&drive})));
  EXPECT_EQ(share_of_false(Provenance::kGhostType1)({&drive}), 0.75);
}

TEST(RunDrive, RepeatsAndKeepsTheEvidenceOfEachJudgedDetection) {
  const DriveSpec spec{"straight_rail", "series_77ghz", 101, 1.0};
  const DriveResult first = run_drive(spec, {}), again = run_drive(spec, {});
  ASSERT_GT(first.detections.size(), 50u);
  ASSERT_EQ(first.detections.size(), again.detections.size());
  for (std::size_t i = 0; i < first.detections.size(); ++i) {
    EXPECT_EQ(first.detections[i].p_moving, again.detections[i].p_moving);
  }
  // Labels of the first scan of a radar cannot be in its base rate.
  EXPECT_EQ(first.detections.front().base_rate, 0.5F);
  for (const auto& lane : first.evidence.lanes) {
    ASSERT_EQ(lane.size(), first.detections.size());
    for (std::size_t i = 0; i < lane.size(); ++i) EXPECT_EQ(lane[i].is_real, first.detections[i].is_real);
  }
  EXPECT_FALSE(first.evidence.lanes[0].back().levels.has_tracks);
  EXPECT_TRUE(first.evidence.lanes[1].back().levels.has_tracks);
}

}  // namespace
}  // namespace boresight::bench::ghosts_drives
