// What the estimator states beside the mounting: wrong input, changes of the vehicle, drift, reason.
#include "tests/unit/health/supervision_bench.hpp"

namespace boresight::health {
namespace {

TEST_F(SupervisionTest, AWrongInputIsReportedInsteadOfAMisalignment) {
  estimate_[1].alignment_yaw_rad = static_cast<float>(20.0 * kRadiansPerDegree);
  run(3.0);
  ASSERT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kMisaligned);
  const HealthReport before = *report_;
  estimate_[1].reason = AlignmentReason::kWrongInput;
  estimate_[1].finding = AlignmentFinding::kNominalYawWrong;
  estimate_[1].finding_value = static_cast<float>(20.0 * kRadiansPerDegree);
  estimate_[1].finding_radar = 1;
  estimate_[1].drift.since_ns = 5;
  run(0.5);
  EXPECT_TRUE(verdicts_differ(before, *report_));
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kAvailableReduced);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kWrongInput);
  EXPECT_EQ(radar(2).reason, AlignmentReason::kWrongInput);
  EXPECT_EQ(radar(2).finding, AlignmentFinding::kNominalYawWrong);
  EXPECT_NEAR(radar(2).finding_value, 20.0 * kRadiansPerDegree, 1e-6);
  EXPECT_EQ(radar(2).finding_radar, 1U);
  EXPECT_EQ(radar(2).yaw.beyond_tolerance, 0);
  EXPECT_EQ(radar(2).yaw.observable, 0);
  EXPECT_EQ(radar(2).drift.since_ns, 0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal);
  run(5.0);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kWrongInput) << "does not become a misalignment";
  estimate_[1].finding = AlignmentFinding::kNone;
  run(0.5);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kInitialising) << "set_s has not passed";
  run(2.0);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kMisaligned);
}

TEST_F(SupervisionTest, ASilentRadarIsReportedAsSilentAndNotByItsOldWrongInput) {
  estimate_[1].finding = AlignmentFinding::kAzimuthMirrored;
  run(3.0);
  silent_radar_ = 2;
  run(1.0);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNoData);
}

TEST_F(SupervisionTest, ChangesOfLoadAndSpeedSignalAreEventsOfTheVehicle) {
  run(2.0);
  EXPECT_EQ(report_->load_change.count, 0U);
  const HealthReport before = *report_;
  for (AlignmentEstimate& estimate : estimate_) {
    estimate.load_change = {now_, static_cast<float>(0.8 * kRadiansPerDegree), 1};
  }
  run(2.0);
  EXPECT_TRUE(verdicts_differ(before, *report_));
  EXPECT_EQ(report_->load_change.count, 1U);
  EXPECT_NEAR(report_->load_change.size, 0.8 * kRadiansPerDegree, 1e-6);
  for (const std::uint32_t id : {1U, 2U}) EXPECT_EQ(radar(id).extended_qualifier, ExtendedQualifier::kNormal);
  estimate_[0].speed_change = {now_, 0.012F, 1};
  estimate_[0].load_change = {};  // the estimator began again: what it reported before stays known
  estimate_[1].load_change = {};
  run(1.0);
  EXPECT_EQ(report_->speed_change.size, 0.012F);
  EXPECT_EQ(report_->load_change.count, 1U);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailable);
}

TEST_F(SupervisionTest, ADriftAndTheReasonAreReportedWithoutChangingTheVerdict) {
  run(2.0);
  const HealthReport before = *report_;
  estimate_[0].state = AlignmentState::kConverging;
  estimate_[0].reason = AlignmentReason::kLargeStd;
  estimate_[0].drift = {now_, 4e-5F, 4e-6F, 0.0F, 4e-6F};
  estimate_[0].nuisance.range_rate_scale = {0.0025F, 0.001F};
  run(1.0);
  EXPECT_TRUE(verdicts_differ(before, *report_)) << "a drift began";
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal);
  EXPECT_EQ(radar(1).reason, AlignmentReason::kLargeStd);
  EXPECT_EQ(radar(1).drift.yaw_radps, 4e-5F);
  EXPECT_EQ(radar(1).range_rate_scale.value, 0.0025F);
}

TEST_F(SupervisionTest, StepChangesAreCounted) {
  run(1.0);
  EXPECT_EQ(radar(2).step_changes, 0u);
  estimate_[1].step_change.count = 2;
  run(1.0);
  EXPECT_EQ(radar(2).step_changes, 2u);
}

TEST_F(SupervisionTest, EstimateOfAWaitingEstimatorIsIgnored) {
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  estimate_[1].state = AlignmentState::kWaiting;
  run(10.0);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kInitialising) << "never verified";
}

}  // namespace
}  // namespace boresight::health
