// Figures of detections, alignment and health of hand-made runs.
#include "services/simulator/judge/detection_judge.hpp"

#include <cmath>
#include <vector>

#include "services/common/geometry/so3.hpp"
#include "services/simulator/judge/alignment_judge.hpp"

namespace boresight::judge {
namespace {

constexpr double kDegree = M_PI / 180.0;

TEST(DetectionJudge, SharesAreThoseOfTheDetections) {
  DetectionJudge judge;
  std::vector<JudgedDetection> scan;
  const auto add = [&](int count, Provenance truth, Provenance label, bool rejected, const char* cause = "") {
    for (int i = 0; i < count; ++i) scan.push_back({truth, cause, label, rejected, kNaN});
  };
  add(6, Provenance::kMoving, Provenance::kMoving, false);
  add(1, Provenance::kMoving, Provenance::kGhostType2, false);
  add(1, Provenance::kMoving, Provenance::kUnknown, true);
  add(2, Provenance::kClutter, Provenance::kMoving, false, "side_lobe");
  add(2, Provenance::kClutter, Provenance::kClutter, false, "side_lobe");
  add(9, Provenance::kStationary, Provenance::kStationary, false, "none");
  judge.add_scan(scan);
  judge.add_scan({});
  FigureList f;
  judge.write(f);
  EXPECT_EQ(f.value("detections.scans"), 2.0);
  EXPECT_DOUBLE_EQ(f.value("detections.moving_that_is_moving_share"), 6.0 / 8.0);
  EXPECT_DOUBLE_EQ(f.value("detections.moving_lost_share"), 2.0 / 8.0);
  EXPECT_DOUBLE_EQ(f.value("detections.moving_rejected_share"), 1.0 / 8.0);
  EXPECT_DOUBLE_EQ(f.value("detections.false_moving_per_scan"), 1.0);
  EXPECT_DOUBLE_EQ(f.value("detections.false_moving_per_scan_p90"), 2.0);
  EXPECT_EQ(f.value("detections.confusion.moving.ghost_type_2"), 1.0);
  EXPECT_EQ(f.value("detections.confusion.moving.rejected"), 1.0);
  EXPECT_EQ(f.value("detections.cause.side_lobe.count"), 4.0);
  EXPECT_EQ(f.value("detections.cause.side_lobe.moving"), 2.0);
  EXPECT_EQ(f.find("detections.cause.none.count"), nullptr);
  EXPECT_TRUE(std::isnan(f.value("detections.brier"))) << "no probabilities";
}

TEST(DetectionJudge, BrierScoreIsTheMeanSquareOfTheError) {
  DetectionJudge judge;
  const std::vector<JudgedDetection> scan = {
      {Provenance::kMoving, "", Provenance::kMoving, false, 0.8},
      {Provenance::kStationary, "", Provenance::kStationary, false, 0.1},
      {Provenance::kClutter, "", Provenance::kMoving, false, 0.6},
      {Provenance::kMoving, "", Provenance::kUnknown, true, 0.0},  // rejected: not asked
  };
  judge.add_scan(scan);
  FigureList f;
  judge.write(f);
  EXPECT_NEAR(f.value("detections.brier"), (0.04 + 0.01 + 0.36) / 3.0, 1e-12);
  EXPECT_NEAR(f.value("detections.brier_of_base_rate"), 2.0 / 9.0, 1e-12);
  EXPECT_EQ(f.value("detections.reliability.0.6_0.7.count"), 1.0);
  EXPECT_EQ(f.value("detections.reliability.0.6_0.7.moving_share"), 0.0);
  EXPECT_TRUE(std::isnan(f.value("detections.reliability.0.2_0.3.moving_share")));
}

TEST(DetectionJudge, WithoutScansNothingIsKnown) {
  FigureList f;
  DetectionJudge().write(f);
  for (const Figure& figure : f.all()) {
    EXPECT_EQ(std::isnan(figure.value), figure.name != "detections.scans") << figure.name;
  }
}

/// An estimate with an error about the vehicle's z axis.
AlignmentSample estimate_at(double t_s, double z_error_rad, const MountingTruth& truth,
                            std::uint32_t step_changes = 0) {
  AlignmentSample sample;
  sample.t_s = t_s;
  sample.radar = 2;
  sample.speed_scale = truth.speed_scale + 0.001;
  sample.rotation = geometry::so3_exp({0.0, 0.0, z_error_rad}) * truth.rotation;
  sample.variances = {1e-6, 1e-6, 1e-6, 1e-4};
  sample.step_changes = step_changes;
  return sample;
}

TEST(AlignmentJudge, ErrorsAreAboutTheVehiclesAxes) {
  MountingTruth truth;
  truth.speed_scale = 1.01;
  truth.has_rotation = true;
  truth.rotation = geometry::fixed_axes_rotation(0.04, -0.02, 0.03);
  AlignmentJudge judge;
  for (int t = 0; t <= 120; ++t) judge.add(estimate_at(t, t < 60 ? 0.5 : 0.01, truth), truth);
  FigureList f;
  judge.write(f);
  EXPECT_NEAR(f.value("alignment.radar_2.rotation_z.error_deg"), 0.01 / kDegree, 1e-9);
  EXPECT_NEAR(f.value("alignment.radar_2.rotation_x.error_deg"), 0.0, 1e-9);
  EXPECT_NEAR(f.value("alignment.radar_2.rotation_z.rms_deg"), 0.01 / kDegree, 1e-9)
      << "the first minute does not count";
  EXPECT_NEAR(f.value("alignment.radar_2.rotation_z.nees"), 1.0, 1e-9);
  EXPECT_NEAR(f.value("alignment.radar_2.speed_scale.error"), 0.001, 1e-12);
  EXPECT_NEAR(f.value("alignment.radar_2.speed_scale.nees"), 1.0, 1e-6);
  EXPECT_EQ(f.value("alignment.false_step_changes_per_hour"), 0.0);
}

TEST(AlignmentJudge, ShortRunHasNoRmsError) {
  MountingTruth truth;
  truth.speed_scale = 1.0;
  truth.has_rotation = true;
  AlignmentJudge judge;
  for (int t = 0; t <= 30; ++t) judge.add(estimate_at(t, 0.0, truth), truth);
  FigureList f;
  judge.write(f);
  EXPECT_TRUE(std::isnan(f.value("alignment.radar_2.rotation_z.rms_deg")));
  EXPECT_NEAR(f.value("alignment.radar_2.rotation_z.error_deg"), 0.0, 1e-9);
}

TEST(AlignmentJudge, StepChangesAreTrueFalseOrMissed) {
  // True changes at 100 s (reported at 103 s) and at 300 s (never); false reports at 200 s and 203 s.
  AlignmentJudge judge;
  for (int t = 0; t <= 360; ++t) {
    MountingTruth truth;
    truth.has_rotation = true;
    truth.step_changes = (t >= 100 ? 1U : 0U) + (t >= 300 ? 1U : 0U);
    const std::uint32_t reported = (t >= 103 ? 1U : 0U) + (t >= 200 ? 1U : 0U) + (t >= 203 ? 1U : 0U);
    judge.add(estimate_at(t, 0.0, truth, reported), truth);
  }
  FigureList f;
  judge.write(f);
  EXPECT_EQ(f.value("alignment.false_step_changes"), 2.0);
  EXPECT_EQ(f.value("alignment.missed_step_changes"), 1.0);
  EXPECT_NEAR(f.value("alignment.false_step_changes_per_hour"), 20.0, 1e-9);
}

TEST(AlignmentJudge, WithoutTruthThereIsNoError) {
  AlignmentJudge judge;
  const MountingTruth unknown;
  for (int t = 0; t <= 100; ++t) judge.add(estimate_at(t, 0.0, unknown, 3), unknown);
  FigureList f;
  judge.write(f);
  EXPECT_EQ(f.value("alignment.radar_2.step_changes"), 3.0);
  for (const char* const name : {"alignment.radar_2.rotation_z.error_deg", "alignment.radar_2.speed_scale.error",
                                 "alignment.radar_2.false_step_changes", "alignment.false_step_changes_per_hour"}) {
    EXPECT_TRUE(std::isnan(f.value(name))) << name;
  }
}

TEST(HealthJudge, WrongVerdictsAreCountedInSecondsByKind) {
  HealthJudge judge;
  // 0 … 10 s right, 10 … 13 s misaligned though within, 13 … 20 s right, 20 … 24 s not misaligned though beyond.
  for (int t = 0; t <= 24; ++t) judge.add(t, 1, t >= 10 && t < 13, t >= 20);
  for (int t = 0; t <= 24; ++t) judge.add(t, 2, true, true);
  FigureList f;
  judge.write(f);
  EXPECT_DOUBLE_EQ(f.value("health.radar_1.misaligned_though_within_tolerance_s"), 3.0);
  EXPECT_DOUBLE_EQ(f.value("health.radar_1.not_misaligned_though_beyond_tolerance_s"), 4.0);
  EXPECT_DOUBLE_EQ(f.value("health.radar_2.misaligned_though_within_tolerance_s"), 0.0);
  EXPECT_DOUBLE_EQ(f.value("health.judged_s"), 48.0);
  FigureList nothing;
  HealthJudge().write(nothing);
  EXPECT_TRUE(std::isnan(nothing.value("health.judged_s")));
}

}  // namespace
}  // namespace boresight::judge
