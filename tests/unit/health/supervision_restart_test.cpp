// What health says after a restart: the last known verdict, or INITIALISING, and never AVAILABLE before a test.
#include <utility>

#include "services/health/core/faults/codec.hpp"
#include "tests/unit/health/supervision_bench.hpp"

namespace boresight::health {
namespace {

using enum DataQualifier;
using enum ExtendedQualifier;

class RestartTest : public SupervisionTest {
 protected:
  /// Another health process, with the stored fault memory of this one unless `forgets`.
  void restart(bool forgets = false, const VehicleConfig& vehicle = two_radars()) {
    std::vector<std::uint8_t> bytes(kMaxFaultMemoryBytes);
    bytes.resize(encode_fault_memory(supervision_.faults(), bytes));
    supervision_ = Supervision(vehicle, Config{.set_s = 1.0, .clear_s = 1.0, .faults = {}}, now_);
    if (!forgets) {
      ASSERT_EQ(decode_fault_memory(bytes, supervision_.faults()), StoredFaults::kTaken);
    }
    supervision_.restored();
    supervision_.judge(*report_, now_, kEpoch + now_);
  }
  void expect(std::uint32_t id, DataQualifier effect, ExtendedQualifier reason) {
    EXPECT_EQ(radar(id).data_qualifier, effect) << "radar " << id;
    EXPECT_EQ(radar(id).extended_qualifier, reason) << "radar " << id;
  }
};

TEST_F(RestartTest, AMisalignedRadarStaysMisalignedFromTheFirstReportOn) {
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(5.0);
  expect(2, kAvailableReduced, kMisaligned);
  restart();
  expect(2, kAvailableReduced, kMisaligned);
  EXPECT_EQ(radar(2).yaw.beyond_tolerance, 1);
  EXPECT_NEAR(radar(2).yaw.error_rad, 2.5 * kRadiansPerDegree, 1e-6) << "as last known";
  EXPECT_NEAR(radar(2).lateral_displacement_m, 4.36, 0.01);
  EXPECT_EQ(report_->stored_events, 1u);
  expect(1, kNotAvailable, kInitialising);
  run(0.3);
  expect(2, kAvailableReduced, kMisaligned);
  expect(1, kNotAvailable, kInitialising);
  run(0.5);
  expect(1, kAvailable, kNormal);
  run(5.0);
  expect(2, kAvailableReduced, kMisaligned);
  EXPECT_EQ(supervision_.faults().find({kind_of(RadarEvent::kYawMisaligned), 2})->status.occurrences, 1)
      << "the same occurrence goes on";
}

TEST_F(RestartTest, ARadarBeyondItsLimitStaysNotAvailableUntilItIsClearlyWithin) {
  estimate_[1].alignment_yaw_rad = static_cast<float>(3.5 * kRadiansPerDegree);
  run(5.0);
  expect(2, kNotAvailable, kMisaligned);
  const float lost = radar(2).lost_coverage_ratio;
  EXPECT_GT(lost, 0.0F);
  restart();
  EXPECT_EQ(radar(2).yaw.effect, AxisEffect::kNotAvailable);
  EXPECT_EQ(radar(2).yaw.beyond_limit_probability, 1.0F);
  EXPECT_EQ(radar(2).lost_coverage_ratio, lost) << "as last known";
  const std::uint32_t observable = std::exchange(estimate_[1].observable, 0u);
  run(2.0);
  EXPECT_EQ(radar(2).lost_coverage_ratio, lost) << "an estimate without an observable angle says nothing";
  expect(2, kNotAvailable, kMisaligned);
  estimate_[1].observable = observable;
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.9 * kRadiansPerDegree);
  run(5.0);
  expect(2, kNotAvailable, kMisaligned);
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(3.0);
  expect(2, kAvailableReduced, kMisaligned);
}

TEST_F(RestartTest, AMisalignedRadarWithoutNewEstimatesStaysMisaligned) {
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(5.0);
  restart();
  estimate_[1].state = AlignmentState::kWaiting;
  run(60.0);
  expect(2, kAvailableReduced, kMisaligned);
  estimate_[1].state = AlignmentState::kConverged;
  estimate_[1].alignment_yaw_rad = static_cast<float>(1.42 * kRadiansPerDegree);
  run(5.0);
  expect(2, kAvailableReduced, kMisaligned);
  EXPECT_EQ(radar(2).yaw.beyond_tolerance, 1) << "hysteresis survives the restart";
  estimate_[1].alignment_yaw_rad = static_cast<float>(0.1 * kRadiansPerDegree);
  run(5.0);
  expect(2, kAvailable, kNormal);
}

TEST_F(RestartTest, WithoutAStoredVerdictARadarIsInitialisingUntilItsMountingWasVerified) {
  run(5.0);
  expect(1, kAvailable, kNormal);
  restart(true);
  expect(1, kNotAvailable, kInitialising);
  estimate_[0].state = AlignmentState::kConverging;
  estimate_[0].covariance[5] = 1.0F;  // rad²: says nothing
  run(60.0);
  expect(1, kAvailableReduced, kInitialising);
  EXPECT_NE(radar(1).untested_events & bit_of(RadarEvent::kYawMisaligned), 0u);
  expect(2, kAvailable, kNormal);
  estimate_[0].covariance[5] = 1e-7F;
  run(2.0);
  expect(1, kAvailable, kNormal);
}

TEST_F(RestartTest, AClearedMisalignmentIsNotAvailableBeforeItWasTestedAgain) {
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(5.0);
  ASSERT_TRUE(supervision_.faults().clear(dtc_of({kind_of(RadarEvent::kYawMisaligned), 2})));
  supervision_.judge(*report_, now_, kEpoch + now_);
  EXPECT_NE(radar(2).data_qualifier, kAvailable);
  run(3.0);
  expect(2, kAvailableReduced, kMisaligned);
}

TEST_F(RestartTest, ASilentRadarIsNeverAvailableAfterARestart) {
  run(5.0);
  silent_radar_ = 2;
  run(1.0);
  expect(2, kNotAvailable, kNoData);
  restart();
  EXPECT_EQ(radar(2).data_qualifier, kNotAvailable);
  run(5.0);
  expect(2, kNotAvailable, kNoData);
  silent_radar_ = 0;
  run(1.5);
  expect(2, kAvailable, kNormal);
}

TEST_F(RestartTest, ABlockedRadarStaysBlockedUntilTheSensorReportsAgain) {
  status_[0].sources[0].conditions = source_condition::kReported | source_condition::kBlocked;
  run(5.0);
  expect(1, kNotAvailable, kBlocked);
  // The gateway restarts: it has not heard of the sensor yet.
  status_[0].sources[0].conditions = 0;
  restart();
  run(2.0);
  expect(1, kNotAvailable, kBlocked);
  status_[0].sources[0].conditions = source_condition::kReported;
  run(0.5);
  expect(1, kAvailable, kNormal);
}

TEST_F(RestartTest, AWrongInputWithdrawsTheVerdictOnTheMountingAlsoInTheMemory) {
  estimate_[0].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(5.0);
  expect(1, kAvailableReduced, kMisaligned);
  estimate_[0].finding = AlignmentFinding::kSpeedUnit;
  run(1.0);
  expect(1, kAvailableReduced, kWrongInput);
  EXPECT_FALSE(supervision_.faults().is_failed({kind_of(RadarEvent::kYawMisaligned), 1}));
  estimate_[0].finding = AlignmentFinding::kNone;
  estimate_[0].alignment_yaw_rad = 0.0F;
  run(0.5);
  expect(1, kAvailableReduced, kInitialising);
  run(3.0);
  expect(1, kAvailable, kNormal);
}

TEST_F(RestartTest, ARadarThatIsBlindAfterTheRestartIsFoundByTheKeptLevel) {
  drive(20.0F);
  run(20.0);
  const VehicleLevels levels = supervision_.levels();
  ASSERT_EQ(levels.number_of_radars, 2u);
  restart();
  supervision_.restore(levels);
  drive(20.0F);
  detections_[2] = 2;
  run(5.0);
  expect(1, kAvailable, kNormal);
  expect(2, kNotAvailable, kBlocked);
  restart();
  drive(20.0F);
  run(5.0);
  EXPECT_EQ(supervision_.levels().radars[1].sight.log_count.learnt_s, 0.0) << "and no level is learnt of it";
}

TEST_F(RestartTest, ARadarThatIsBlindFromTheFirstStartIsFoundAfterTheLearningTime) {
  drive(20.0F);
  detections_[2] = 1;
  run(14.0);
  expect(1, kAvailable, kNormal);
  expect(2, kNotAvailable, kBlocked);
}

TEST_F(RestartTest, TheFreezeFrameHoldsWhatWasKnown) {
  supervision_.set_origin(0x1234, "9.8.7");
  EgoMotion motion{};
  motion.fields = ego_field::kSpeed;
  motion.speed_mps = 13.9F;
  supervision_.observe(motion);
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(5.0);
  const FreezeFrame& frame = supervision_.faults().find({kind_of(RadarEvent::kYawMisaligned), 2})->latest;
  EXPECT_EQ(frame.speed_mps, 13.9F);
  EXPECT_NEAR(frame.estimate[1], 2.5 * kRadiansPerDegree, 1e-6);
  EXPECT_EQ(frame.covariance[4], estimate_[1].covariance[5]);
  EXPECT_NEAR(frame.lateral_displacement_m, 4.36, 0.01);
  EXPECT_EQ(frame.lost_coverage_ratio, radar(2).lost_coverage_ratio);
  EXPECT_EQ(frame.range_loss_ratio, radar(2).range_loss_ratio);
  EXPECT_NEAR(frame.velocity_error_mps, 2.0 * 13.9 * std::sin(1.25 * kRadiansPerDegree), 1e-5);
  EXPECT_EQ(frame.configuration, 0x1234u);
  EXPECT_STREQ(frame.software.data(), "9.8.7");
  EXPECT_GT(frame.time_ns, kEpoch);
}

TEST_F(RestartTest, ALoadChangeIsOneOccurrenceAlsoOverARestart) {
  run(3.0);
  estimate_[0].load_change = {now_, 0.01F, 1};
  run(1.0);
  restart();
  run(1.0);
  const FaultRecord& record = *supervision_.faults().find({EventKind::kLoadChange});
  EXPECT_EQ(record.status.occurrences, 1);
  estimate_[0].load_change = {now_, -0.01F, 2};
  run(1.0);
  EXPECT_EQ(supervision_.faults().find({EventKind::kLoadChange})->status.occurrences, 2);
  EXPECT_EQ(radar(1).data_qualifier, kAvailable) << "an event of the vehicle, not of a radar";
}

TEST_F(RestartTest, AServiceThatNeverStartsIsSilentAfterItsGrace) {
  mute_[static_cast<std::size_t>(Service::kGhostFilter)] = true;
  run(4.0);
  EXPECT_EQ(service(Service::kGhostFilter).condition, ServiceCondition::kUnknown);
  run(2.0);
  EXPECT_EQ(service(Service::kGhostFilter).condition, ServiceCondition::kSilent);
  EXPECT_TRUE(supervision_.faults().is_failed({EventKind::kServiceSilent, 3}));
}

}  // namespace
}  // namespace boresight::health
