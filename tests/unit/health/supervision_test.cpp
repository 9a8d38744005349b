#include "tests/unit/health/supervision_bench.hpp"

namespace boresight::health {
namespace {

TEST_F(SupervisionTest, HealthySystemIsAvailable) {
  run(5.0);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailable);
  EXPECT_EQ(report_->number_of_sensors, 2u);
  EXPECT_EQ(report_->number_of_services, 6u);
  for (std::uint32_t id : {1u, 2u}) {
    EXPECT_EQ(radar(id).data_qualifier, DataQualifier::kAvailable);
    EXPECT_EQ(radar(id).extended_qualifier, ExtendedQualifier::kNormal);
    EXPECT_NEAR(radar(id).rate_hz, 20.0, 0.6);
    EXPECT_EQ(radar(id).lost_scans, 0u);
    EXPECT_NEAR(radar(id).detections_per_scan, 40.0, 1e-3);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(report_->services[i].condition, ServiceCondition::kAlive) << i;
    EXPECT_EQ(report_->services[i].deadline_missed, 0) << i;
  }
}

TEST_F(SupervisionTest, RadarWithoutAScanIsInitialisingAndThenNoData) {
  supervision_.judge(*report_, kStart + 100 * kMillisecond, kEpoch);
  EXPECT_EQ(radar(1).data_qualifier, DataQualifier::kNotAvailable);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kInitialising);
  EXPECT_LT(radar(1).last_seen_s, 0.0F);
  EXPECT_EQ(service(Service::kTracker).condition, ServiceCondition::kUnknown);
  EXPECT_LT(service(Service::kTracker).last_heartbeat_s, 0.0F);
  EXPECT_EQ(report_->overall, DataQualifier::kNotAvailable);
  supervision_.judge(*report_, kStart + 300 * kMillisecond, kEpoch);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNoData);
}

TEST_F(SupervisionTest, SilentRadarIsNotAvailableAtItsDeadlineAndAvailableSoonAfterItsNextScan) {
  run(5.0);
  silent_radar_ = 2;
  run(0.2);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kAvailable);
  run(0.1);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kNotAvailable);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNoData);
  EXPECT_EQ(radar(2).rate_hz, 0.0F);
  EXPECT_EQ(radar(1).data_qualifier, DataQualifier::kAvailable);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailableReduced) << "the other radar is available";
  run(10.0);
  silent_radar_ = 0;
  run(0.1);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kNotAvailable) << "debounced";
  run(1.1);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kAvailable);
  EXPECT_NEAR(radar(2).rate_hz, 20.0, 1.0);
}

TEST_F(SupervisionTest, HalfTheRateIsRateReduced) {
  scan_every_ = 10;
  run(0.4);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kInitialising) << "ten scans were not due yet";
  run(4.6);
  EXPECT_EQ(radar(1).data_qualifier, DataQualifier::kAvailableReduced);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kRateReduced);
  scan_every_ = 5;
  run(4.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal);
}

TEST_F(SupervisionTest, MisalignedRadarIsReducedAndFarBeyondToleranceNotAvailable) {
  run(3.0);
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(3.0);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kAvailableReduced);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kMisaligned);
  EXPECT_EQ(radar(2).yaw.beyond_tolerance, 1);
  EXPECT_NEAR(radar(2).lateral_displacement_m, 100.0 * std::sin(2.5 * kRadiansPerDegree), 1e-3);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailableReduced);
  EXPECT_EQ(radar(2).yaw.effect, AxisEffect::kReduced);
  EXPECT_EQ(radar(1).yaw.effect, AxisEffect::kCompensated);
  EXPECT_EQ(radar(1).pitch.effect, AxisEffect::kUnknown) << "not observable";
  estimate_[1].alignment_yaw_rad = static_cast<float>(-3.2 * kRadiansPerDegree);
  run(2.0);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kNotAvailable);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kMisaligned);
  EXPECT_EQ(radar(2).yaw.effect, AxisEffect::kNotAvailable);
  estimate_[1].alignment_yaw_rad = static_cast<float>(-2.5 * kRadiansPerDegree);
  run(2.0);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kAvailableReduced);
}

TEST_F(SupervisionTest, ConsequencesOfAMisalignmentAreReported) {
  run(1.0);
  EXPECT_EQ(radar(2).lost_coverage_ratio, 0.0F);
  EXPECT_TRUE(std::isnan(radar(2).velocity_error_mps)) << "no speed was received";
  EgoMotion motion{};
  motion.fields = ego_field::kSpeed;
  motion.speed_mps = 20.0F;
  supervision_.observe(motion);
  estimate_[1].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(3.0);
  // Of a field of view of 2.6 rad, 2.5° at one edge are lost.
  EXPECT_NEAR(radar(2).lost_coverage_ratio, 2.5 * kRadiansPerDegree / 2.6, 1e-4);
  EXPECT_NEAR(radar(2).velocity_error_mps, 40.0 * std::sin(1.25 * kRadiansPerDegree), 1e-4);
  EXPECT_GT(radar(2).range_loss_ratio, 0.0F);
  EXPECT_EQ(radar(1).lost_coverage_ratio, 0.0F);
  EXPECT_EQ(radar(1).velocity_error_mps, 0.0F);
}

TEST_F(SupervisionTest, EachAxisHasItsToleranceAndOnlyObservableAxesCount) {
  estimate_[0].alignment_pitch_rad = static_cast<float>(2.0 * kRadiansPerDegree);
  estimate_[1].alignment_roll_rad = static_cast<float>(2.0 * kRadiansPerDegree);
  run(5.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal) << "pitch is not observable";
  estimate_[0].observable |= alignment_axis::kPitch;
  estimate_[1].observable |= alignment_axis::kRoll;
  run(5.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kMisaligned);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNormal) << "2° of roll are within 3°";
}

TEST_F(SupervisionTest, PitchThatIsObservableAboutTheVehicleAxisOnlyCounts) {
  // A radar that looks 45° to the side. On straight roads neither pitch nor roll about its own axes is observable.
  VehicleConfig vehicle = two_radars();
  vehicle.radars[0].mounting_pose.yaw_rad = 45.0 * kRadiansPerDegree;
  vehicle.radars[1].mounting_pose.yaw_rad = 90.0 * kRadiansPerDegree;
  supervision_ = Supervision(vehicle, Config{.set_s = 1.0, .clear_s = 1.0, .faults = {}}, now_);
  run(3.0);
  for (auto& estimate : estimate_) {
    estimate.observable |= alignment_axis::kVehiclePitch | alignment_axis::kVehicleYaw;
    estimate.vehicle_pitch_rad = static_cast<float>(2.0 * kRadiansPerDegree);
    estimate.vehicle_covariance[10] = static_cast<float>(0.02 * kRadiansPerDegree * 0.02 * kRadiansPerDegree);
  }
  run(3.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal) << "a share of 0.71 is pitch of the sensor";
  EXPECT_EQ(radar(1).pitch.observable, 1);
  EXPECT_EQ(radar(1).pitch.about_vehicle_axis, 1);
  EXPECT_NEAR(radar(1).pitch.tolerance_rad, 1.5 * std::sqrt(2.0) * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(radar(2).pitch.tolerance_rad, 3.0 * kRadiansPerDegree, 1e-6) << "to the side it is the sensor's roll";
  for (auto& estimate : estimate_) estimate.vehicle_pitch_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(3.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kMisaligned);
  EXPECT_EQ(radar(1).pitch.beyond_tolerance, 1);
  EXPECT_NEAR(radar(1).pitch.error_rad, 2.5 * kRadiansPerDegree, 1e-6);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNormal);
}

TEST_F(SupervisionTest, RejectedFramesAreInvalidData) {
  run(3.0);
  for (int i = 0; i < 30; ++i) {
    status_[0].sources[0].rejected += 2;  // 20 a second beside 20 good ones
    run(0.1);
  }
  EXPECT_EQ(radar(1).data_qualifier, DataQualifier::kAvailableReduced);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kInvalidData);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNormal);
  run(5.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal);
}

TEST_F(SupervisionTest, SuspectScansBeyondTheirShareAreInvalidData) {
  run(3.0);
  const auto run_with_suspects = [this](int every_nth_tenth_of_a_second) {
    for (int i = 0; i < 30; ++i) {
      if (i % every_nth_tenth_of_a_second == 0) ++status_[0].sources[0].suspect;  // beside 2 scans in that time
      run(0.1);
    }
  };
  run_with_suspects(10);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal) << "1 of 20 is within 10 %";
  EXPECT_EQ(radar(1).suspect_scans, 3u);
  run_with_suspects(1);
  EXPECT_EQ(radar(1).data_qualifier, DataQualifier::kAvailableReduced);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kInvalidData);
  EXPECT_EQ(radar(1).suspect_scans, 33u);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNormal);
  run(5.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal);
}

TEST_F(SupervisionTest, ConditionsReportedByTheSensorSetTheVerdict) {
  run(3.0);
  SourceStatistics& source = status_[0].sources[0];
  const auto verdict_with = [&](std::uint32_t conditions) {
    source.conditions = source_condition::kReported | conditions;
    run(0.2);
    EXPECT_EQ(radar(1).conditions, conditions);
    EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNormal);
    return std::pair(radar(1).data_qualifier, radar(1).extended_qualifier);
  };
  using enum DataQualifier;
  using enum ExtendedQualifier;
  namespace c = source_condition;
  EXPECT_EQ(verdict_with(c::kPartlyBlocked), std::pair(kAvailableReduced, kBeginningBlockage));
  EXPECT_EQ(verdict_with(c::kBlocked), std::pair(kNotAvailable, kBlocked));
  EXPECT_EQ(verdict_with(c::kDefective), std::pair(kNotAvailable, kInvalidData));
  EXPECT_EQ(verdict_with(c::kSupply | c::kTemperature | c::kUnsynchronised | c::kWithoutEgoMotion),
            std::pair(kAvailable, kNormal))
      << "reported, but no reason to distrust its data";
  EXPECT_EQ(verdict_with(0), std::pair(kAvailable, kNormal));
}

TEST_F(SupervisionTest, WorstEffectIsReportedAndThenTheReasonThatAWorkshopMustRepair) {
  estimate_[0].alignment_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  run(3.0);
  SourceStatistics& source = status_[0].sources[0];
  source.conditions = source_condition::kReported | source_condition::kPartlyBlocked;
  run(0.2);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kMisaligned);
  estimate_[0].alignment_yaw_rad = static_cast<float>(8.0 * kRadiansPerDegree);
  source.conditions = source_condition::kReported | source_condition::kBlocked | source_condition::kPartlyBlocked;
  run(1.0);
  EXPECT_EQ(radar(1).data_qualifier, DataQualifier::kNotAvailable);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kBlocked);
  silent_radar_ = 1;
  run(1.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kBlocked) << "the blockage explains the silence";
  source.conditions = source_condition::kReported;
  run(0.2);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNoData);
}

TEST_F(SupervisionTest, InterferenceIsAnExternalDisturbanceAsLongAsItLasts) {
  drive(20.0F);
  run(30.0);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNormal);
  interference_[2] = 40;
  run(5.0);
  EXPECT_EQ(radar(2).data_qualifier, DataQualifier::kAvailableReduced);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kExternalDisturbance);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kNormal);
  interference_[2] = 0;
  run(5.0);
  EXPECT_EQ(radar(2).extended_qualifier, ExtendedQualifier::kNormal);
}

TEST_F(SupervisionTest, FrozenScansAreNoDisturbanceAndTeachNoLevel) {
  drive(20.0F);
  scan_->integrity = scan_integrity::kFrozen;
  run(30.0);
  EXPECT_EQ(radar(1).extended_qualifier, ExtendedQualifier::kInvalidData);
  EXPECT_EQ(supervision_.levels().radars[0].sight.log_count.learnt_s, 0.0);
  EXPECT_EQ(supervision_.levels().radars[0].log_unexplained.learnt_s, 0.0);
}

TEST_F(SupervisionTest, ScansLostBeforeTheGatewayAreReported) {
  status_[0].sources[0].lost = 7;
  status_[0].sources[0].e2e_lost = 8;
  status_[0].sources[0].e2e_repeated = 9;
  status_[0].sources[0].e2e_wrong = 10;
  run(1.0);
  EXPECT_EQ(radar(1).missed_scans, 7u);
  EXPECT_EQ(radar(1).e2e_lost, 8u);
  EXPECT_EQ(radar(1).e2e_repeated, 9u);
  EXPECT_EQ(radar(1).e2e_wrong, 10u);
  EXPECT_EQ(radar(1).lost_scans, 0u) << "nothing was lost behind the gateway";
  EXPECT_EQ(radar(2).missed_scans, 0u);
}

TEST_F(SupervisionTest, GapsAreCountedAndARestartIsNoGap) {
  run(1.0);
  sequence_[1] += 3;
  run(1.0);
  EXPECT_EQ(radar(1).lost_scans, 3u);
  sequence_[1] = 0;
  run(1.0);
  EXPECT_EQ(radar(1).lost_scans, 3u);
}

TEST_F(SupervisionTest, AServiceWithoutHeartbeatIsSilentAndBreaksTheChain) {
  run(3.0);
  mute_[static_cast<std::size_t>(Service::kGhostFilter)] = true;
  run(0.4);
  EXPECT_NE(service(Service::kGhostFilter).condition, ServiceCondition::kSilent);
  run(0.2);
  EXPECT_EQ(service(Service::kGhostFilter).condition, ServiceCondition::kSilent);
  EXPECT_EQ(report_->overall, DataQualifier::kNotAvailable);
  EXPECT_EQ(service(Service::kTracker).condition, ServiceCondition::kAlive);
}

TEST_F(SupervisionTest, APipelineThatDeliversNoTracksMakesTheWholeNotAvailable) {
  run(3.0);
  const HealthReport before = *report_;
  idle_[static_cast<std::size_t>(Service::kTracker)] = true;
  run(0.2);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailable);
  run(0.25);
  EXPECT_EQ(report_->pipeline.data_qualifier, DataQualifier::kNotAvailable);
  EXPECT_EQ(report_->overall, DataQualifier::kNotAvailable);
  HealthReport after = before;
  after.pipeline = report_->pipeline;
  EXPECT_TRUE(verdicts_differ(before, after)) << "sent at once";
  after.pipeline = before.pipeline;
  after.pipeline.lost_scans += 1;
  EXPECT_FALSE(verdicts_differ(before, after)) << "a number only";
}

TEST_F(SupervisionTest, AReducedPipelineReducesTheWhole) {
  run(3.0);
  status(Service::kTracker).faults[static_cast<std::size_t>(Fault::kWorkBudget)] = 1000;
  run(0.4);
  EXPECT_EQ(report_->pipeline.data_qualifier, DataQualifier::kAvailableReduced);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailableReduced);
  EXPECT_EQ(service(Service::kTracker).condition, ServiceCondition::kAlive) << "a work budget loses nothing";
  run(3.0);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailable);
}

TEST_F(SupervisionTest, DataAreAvailableWithoutTheEstimator) {
  run(3.0);
  mute_[static_cast<std::size_t>(Service::kAlignmentEstimator)] = true;
  run(1.0);
  EXPECT_EQ(service(Service::kAlignmentEstimator).condition, ServiceCondition::kSilent);
  EXPECT_EQ(report_->overall, DataQualifier::kAvailableReduced);
}

TEST_F(SupervisionTest, ANewIncarnationIsARestartForAWhile) {
  run(3.0);
  status(Service::kTracker).incarnation_ns = now_;
  status(Service::kTracker).outputs = 0;
  run(1.0);
  EXPECT_EQ(service(Service::kTracker).condition, ServiceCondition::kRestarted);
  EXPECT_EQ(service(Service::kTracker).restarts, 1u);
  // A heartbeat of the dead process that was still in the queue is not a second restart.
  ServiceStatus late = status(Service::kTracker);
  late.incarnation_ns = kStart - 100 * kMillisecond;
  supervision_.observe(late, now_);
  run(4.0);
  EXPECT_EQ(service(Service::kTracker).condition, ServiceCondition::kAlive);
  EXPECT_EQ(service(Service::kTracker).restarts, 1u);
}

TEST_F(SupervisionTest, TheFirstStageThatDoesNotDeliverIsNamed) {
  run(3.0);
  for (const Service s : {Service::kDetectionCorrector, Service::kGhostFilter, Service::kTracker}) {
    idle_[static_cast<std::size_t>(s)] = true;  // alive, but without output
  }
  run(2.0);
  EXPECT_EQ(service(Service::kDetectionCorrector).deadline_missed, 1);
  EXPECT_EQ(service(Service::kDetectionCorrector).condition, ServiceCondition::kDegraded);
  EXPECT_EQ(service(Service::kGhostFilter).deadline_missed, 0);
  EXPECT_EQ(service(Service::kTracker).deadline_missed, 0);
}

TEST_F(SupervisionTest, NoStageIsLateWhenNoRadarDelivers) {
  run(3.0);
  idle_.fill(true);
  scan_every_ = 1'000'000;
  run(5.0);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(report_->services[i].deadline_missed, 0) << i;
  EXPECT_EQ(report_->overall, DataQualifier::kNotAvailable) << "both radars are silent";
}

TEST_F(SupervisionTest, LostInputDegradesForTheWindow) {
  run(3.0);
  status(Service::kTracker).faults[static_cast<std::size_t>(Fault::kInputLost)] = 2;
  run(0.5);
  EXPECT_EQ(service(Service::kTracker).condition, ServiceCondition::kDegraded);
  EXPECT_EQ(service(Service::kTracker).lost_inputs, 2u);
  run(4.0);
  EXPECT_EQ(service(Service::kTracker).condition, ServiceCondition::kAlive);
}

TEST_F(SupervisionTest, DroppedScansDegradeLikeLostInputsAndAreCountedApart) {
  run(3.0);
  EXPECT_EQ(service(Service::kGhostFilter).condition, ServiceCondition::kAlive);
  status(Service::kGhostFilter).faults[static_cast<std::size_t>(Fault::kInputDropped)] = 3;
  run(0.5);
  EXPECT_EQ(service(Service::kGhostFilter).condition, ServiceCondition::kDegraded);
  EXPECT_EQ(service(Service::kGhostFilter).dropped_inputs, 3u);
  EXPECT_EQ(service(Service::kGhostFilter).lost_inputs, 0u);
  run(4.0);
  EXPECT_EQ(service(Service::kGhostFilter).condition, ServiceCondition::kAlive);
}

TEST_F(SupervisionTest, LatencyOfAServiceIsThatOfItsHeartbeatsInTheWindow) {
  ServiceStatus& tracker = status(Service::kTracker);
  tracker.latency_count = 8;
  tracker.latency_mean_us = 2000.0F;
  tracker.latency_max_us = 3000.0F;
  run(1.0);
  EXPECT_NEAR(service(Service::kTracker).latency_mean_us, 2000.0, 1e-3);
  EXPECT_EQ(service(Service::kTracker).latency_max_us, 3000.0F);
  EXPECT_EQ(service(Service::kHealth).latency_max_us, 0.0F);
  tracker.latency_mean_us = tracker.latency_max_us = 1000.0F;
  run(4.0);
  EXPECT_EQ(service(Service::kTracker).latency_max_us, 1000.0F) << "two windows later";
  tracker.latency_count = 0;
  tracker.latency_mean_us = tracker.latency_max_us = 0.0F;
  run(4.1);
  EXPECT_EQ(service(Service::kTracker).latency_mean_us, 0.0F) << "no outputs";
}

TEST(LatencyWindow, MeanIsWeightedByTheNumberOfOutputs) {
  LatencyWindow latency(2.0);
  latency.add(0, 1, 1000.0F, 1000.0F);
  latency.add(1, 3, 5000.0F, 6000.0F);
  EXPECT_FLOAT_EQ(latency.mean_us(2), 4000.0F);
  EXPECT_FLOAT_EQ(latency.max_us(2), 6000.0F);
}

TEST_F(SupervisionTest, LatencyIsFromReceptionToTrackList) {
  auto tracks = std::make_unique<TrackList>();
  for (int i = 0; i < 100; ++i) {
    tracks->header.stage(Stage::kIngest) = {now_, now_ + 1000};
    tracks->header.stage(Stage::kTracker).end_ns = now_ + (i == 50 ? 4 : 1) * kMillisecond;
    supervision_.observe(*tracks, now_);
  }
  run(0.1);
  EXPECT_NEAR(report_->latency_p50_ms, 1.0, 0.07);
  EXPECT_NEAR(report_->latency_max_ms, 4.0, 1e-3);
}

TEST_F(SupervisionTest, UnknownRadarsAndServicesAreIgnored) {
  scan_->header.source_id = 9;
  supervision_.observe(*scan_, now_);
  estimate_[0].header.source_id = 16;
  supervision_.observe(estimate_[0]);
  ServiceStatus unknown{};
  unknown.header.source_id = 77;
  supervision_.observe(unknown, now_);
  supervision_.judge(*report_, now_, kEpoch);
  EXPECT_EQ(report_->number_of_sensors, 2u);
}

TEST_F(SupervisionTest, OnlyAVerdictMakesReportsDiffer) {
  run(3.0);
  const auto before = std::make_unique<HealthReport>(*report_);
  run(1.0);
  EXPECT_FALSE(verdicts_differ(*before, *report_));
  status_[0].sources[0].conditions = source_condition::kTemperature;
  run(0.2);
  EXPECT_TRUE(verdicts_differ(*before, *report_)) << "the sensor's own";
  status_[0].sources[0].conditions = 0;
  silent_radar_ = 1;
  run(1.0);
  EXPECT_TRUE(verdicts_differ(*before, *report_));
}

TEST_F(SupervisionTest, AllocatesNothing) {
  run(3.0);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting(true);
    run(10.0);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::health
