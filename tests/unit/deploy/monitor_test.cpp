#include <cmath>
#include <memory>
#include <sstream>

#include "services/boresight/monitor/accumulator.hpp"
#include "services/boresight/monitor/render.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::monitor {
namespace {

VehicleConfig vehicle() {
  VehicleConfig config;
  RadarConfig left;
  left.id = 1;
  left.name = "front_left";
  RadarConfig right = left;
  right.id = 2;
  right.name = "front_right";
  config.radars = {left, right};
  return config;
}

void see_scan(Accumulator& accumulator, std::uint32_t radar, std::uint64_t sequence, std::int64_t now_ns) {
  const auto scan = std::make_unique<RadarScan>();
  scan->header.source_id = radar;
  scan->header.source_sequence = sequence;
  scan->number_of_valid_detections = 150;
  accumulator.observe(*scan, now_ns);
}

void see_misaligned_radar(Accumulator& accumulator) {
  AlignmentEstimate estimate{};
  estimate.header.source_id = 2;
  estimate.state = AlignmentState::kConverged;
  estimate.observable = alignment_axis::kYaw | alignment_axis::kVehicleYaw | alignment_axis::kSpeedScale |
                        alignment_axis::kVehiclePitch | alignment_axis::kYawRateBias;
  estimate.alignment_yaw_rad = estimate.vehicle_yaw_rad = static_cast<float>(2.5 * kRadiansPerDegree);
  estimate.vehicle_pitch_rad = static_cast<float>(-0.7 * kRadiansPerDegree);
  estimate.yaw_rate_bias_radps = static_cast<float>(0.1 * kRadiansPerDegree);
  estimate.yaw_rate_bias_std_radps = static_cast<float>(0.02 * kRadiansPerDegree);
  estimate.step_change.count = 1;
  estimate.kpis.seconds_to_95_percent = {1.0F, 1.4F, std::nanf(""), std::nanf("")};
  estimate.kpis.drift_per_minute[1] = static_cast<float>(0.004 * kRadiansPerDegree);
  estimate.vehicle_covariance[5] = estimate.vehicle_covariance[10] =
      static_cast<float>(std::pow(0.04 * kRadiansPerDegree, 2));
  estimate.speed_scale = 1.03F;
  estimate.covariance[5] = static_cast<float>(std::pow(0.04 * kRadiansPerDegree, 2));
  accumulator.observe(estimate);
  HealthReport report{};
  report.number_of_sensors = 2;
  report.sensors[0].radar_id = 1;
  report.sensors[1].radar_id = 2;
  report.sensors[1].data_qualifier = DataQualifier::kAvailableReduced;
  report.sensors[1].extended_qualifier = ExtendedQualifier::kMisaligned;
  report.sensors[1].conditions = source_condition::kPartlyBlocked | source_condition::kUnsynchronised;
  report.sensors[1].missed_scans = 12;
  report.sensors[1].suspect_scans = 3;
  report.overall = DataQualifier::kAvailableReduced;
  report.pipeline = {.data_qualifier = DataQualifier::kAvailableReduced,
                     .reserved = {},
                     .failed_events = 1U << static_cast<unsigned>(PipelineEvent::kLosing) |
                                      1U << static_cast<unsigned>(PipelineEvent::kLate),
                     .lost_scans = 7,
                     .budget_hits = 2,
                     .queueing_max_ms = 12.5F,
                     .latency_p99_ms = 61.0F};
  report.number_of_services = 1;
  report.services[0].service = 4;
  report.services[0].condition = ServiceCondition::kRestarted;
  report.services[0].restarts = 1;
  accumulator.observe(report);
}

void see_tracks(Accumulator& accumulator) {
  const auto list = std::make_unique<TrackList>();
  list->number_of_tracks = 2;
  list->tracks[0].tracking_id = 7;
  list->tracks[0].position_vehicle_m = {40.0F, 3.0F, 0.0F};
  list->tracks[1].tracking_id = 8;
  list->tracks[1].status = TrackStatus::kConfirmed;
  list->tracks[1].position_vehicle_m = {-10.0F, -2.0F, 0.0F};
  list->tracks[1].velocity_over_ground_mps = {13.0F, 0.0F};
  list->tracks[1].object_class = ObjectClass::kVan;
  list->tracks[1].existence_probability = 0.75F;
  list->tracks[1].mirror_probability = 0.125F;
  for (std::size_t i = 0; i < kNumberOfStages; ++i) {
    const auto begin_ns = static_cast<std::int64_t>(1'000'000 + i * 300'000);
    list->header.stages[i] = {begin_ns, begin_ns + 100'000};
  }
  accumulator.observe(*list);
}

TEST(Accumulator, CountsScansRateAndGapsPerRadar) {
  Accumulator accumulator(vehicle());
  std::uint64_t sequence = 0;
  for (std::int64_t t_ns = 0; t_ns < 4'000'000'000; t_ns += 50'000'000) {
    ++sequence;
    if (sequence == 20) sequence += 3;  // three scans lost
    see_scan(accumulator, 1, sequence, t_ns);
  }
  const Snapshot snapshot = accumulator.snapshot(4'000'000'000);
  EXPECT_EQ(snapshot.radars[0].scans, 80U);
  EXPECT_EQ(snapshot.radars[0].lost, 3U);
  EXPECT_NEAR(snapshot.radars[0].rate_hz, 20.0, 0.6);
  EXPECT_EQ(snapshot.radars[1].scans, 0U);
  EXPECT_DOUBLE_EQ(accumulator.snapshot(7'000'000'000).radars[0].rate_hz, 0.0) << "a silent radar has no rate";
}

TEST(Accumulator, RestartedWriterIsNoLoss) {
  Accumulator accumulator(vehicle());
  see_scan(accumulator, 1, 1000, 0);
  see_scan(accumulator, 1, 1, 1);
  see_scan(accumulator, 1, 2, 2);
  EXPECT_EQ(accumulator.snapshot(3).radars[0].lost, 0U);
}

TEST(Accumulator, TakesReasonAxisAndChangesAndKeepsThemThroughARecord) {
  Accumulator accumulator(vehicle());
  AlignmentEstimate estimate{};
  estimate.header.source_id = 1;
  estimate.reason = AlignmentReason::kWrongInput;
  estimate.finding = AlignmentFinding::kSpeedZero;
  estimate.nuisance.range_rate_scale = {0.0025F, 0.0005F};
  accumulator.observe(estimate);
  HealthReport report{};
  report.number_of_sensors = 2;
  report.sensors[0].radar_id = 1;
  report.sensors[0].extended_qualifier = ExtendedQualifier::kWrongInput;
  report.sensors[0].finding = AlignmentFinding::kSpeedZero;
  report.sensors[1].radar_id = 2;
  report.sensors[1].extended_qualifier = ExtendedQualifier::kMisaligned;
  report.sensors[1].roll = {0.0733F, 0.0037F, 0.0524F, 0.105F, 1.0F, 0.0F, 1, 1, 0, AxisEffect::kReduced};
  report.sensors[1].reference_range_m = 100.0F;
  report.load_change = {5, 0.0136F, 1};
  accumulator.observe(report);
  std::istringstream record(to_json(accumulator.snapshot(1)));
  DamagedLines damaged;
  const std::vector<Snapshot> read = read_snapshots(record, "record", damaged);
  ASSERT_EQ(read.size(), 1U);
  const RadarSnapshot &left = read[0].radars[0], &right = read[0].radars[1];
  EXPECT_EQ(left.details.reason, "wrong_input");
  EXPECT_EQ(left.details.finding, "speed_zero");
  EXPECT_NEAR(left.details.range_rate_scale, 0.0025, 1e-7);
  EXPECT_EQ(left.extended_qualifier, ExtendedQualifier::kWrongInput);
  EXPECT_EQ(left.explanation, "speed signal is zero although the vehicle moves");
  EXPECT_EQ(right.explanation, "roll +4.20 ± 0.21°, reduced: beyond 3°; 0.0 m at 100 m");
  EXPECT_EQ(right.beyond_tolerance, (std::array<bool, 3>{false, false, true}));
  EXPECT_EQ(read[0].load_change, "load changed the vehicle's pitch by +0.78° (nose up)");
  const std::string screen = render_screen(read[0], {.width = 300});
  EXPECT_THAT(screen, ::testing::HasSubstr("reduced: beyond 3°"));
  EXPECT_THAT(screen, ::testing::HasSubstr("load changed the vehicle's pitch"));
}

TEST(Accumulator, UnknownRadarGetsARow) {
  Accumulator accumulator(vehicle());
  see_scan(accumulator, 9, 1, 0);
  EXPECT_EQ(accumulator.snapshot(1).radars.at(2).name, "radar_9");
}

void see_labels(Accumulator& accumulator, std::uint32_t radar, std::uint32_t flags) {
  const auto scan = std::make_unique<ClassifiedScan>();
  scan->header.source_id = radar;
  scan->flags = flags;
  scan->number_of_valid_detections = 5;
  scan->provenance[0] = scan->provenance[1] = Provenance::kMoving;
  scan->provenance[2] = Provenance::kGhostType2;
  scan->provenance[3] = Provenance::kClutter;
  scan->detection_flags[4] = corrected_flag::kWeak;
  accumulator.observe(*scan);
}

TEST(Accumulator, SumsTheLabelsOfDetections) {
  Accumulator accumulator(vehicle());
  see_labels(accumulator, 2, pipeline_flag::kNoTracks);
  see_labels(accumulator, 2, 0);
  const LabelCounts labels = accumulator.snapshot(0).radars[1].labels;
  EXPECT_EQ(labels.of(Provenance::kMoving), 4u);
  EXPECT_EQ(labels.of(Provenance::kGhostType2), 2u);
  EXPECT_EQ(labels.of(Provenance::kClutter), 2u);
  EXPECT_EQ(labels.of(Provenance::kUnknown), 0u);
  EXPECT_EQ(labels.rejected, 2u);
  EXPECT_EQ(labels.detections(), 10u);
  EXPECT_EQ(labels.scans, 2u);
  EXPECT_EQ(labels.scans_without_tracks, 1u);
  EXPECT_EQ(accumulator.snapshot(0).radars[0].labels.scans, 0u);
}

TEST(Accumulator, MeasuresStagesAndTheTotalFromTheStamps) {
  Accumulator accumulator(vehicle());
  see_tracks(accumulator);
  const Snapshot snapshot = accumulator.snapshot(0);
  EXPECT_DOUBLE_EQ(snapshot.latencies[1].max_us(), 100.0);
  EXPECT_DOUBLE_EQ(snapshot.latencies[4].max_us(), 1000.0);
  EXPECT_EQ(snapshot.tracks[0].id, 8U) << "nearest first";
}

TEST(LatencyHistogram, PercentilesAreWithinABucketOfTheTruth) {
  LatencyHistogram histogram;
  for (int us = 1; us <= 1000; ++us) histogram.add(us * 1000);
  EXPECT_NEAR(histogram.percentile_us(0.5), 500.0, 30.0);
  EXPECT_NEAR(histogram.percentile_us(0.99), 990.0, 60.0);
  EXPECT_DOUBLE_EQ(histogram.max_us(), 1000.0);
  EXPECT_DOUBLE_EQ(histogram.percentile_us(1.0), 1000.0);
  histogram.add(5'000'000'000);
  EXPECT_DOUBLE_EQ(histogram.max_us(), 5e6) << "beyond the last bucket";
  EXPECT_DOUBLE_EQ(LatencyHistogram().percentile_us(0.5), 0.0);
}

/// A snapshot with a value in every part.
Snapshot eventful_snapshot() {
  Accumulator accumulator(vehicle());
  see_scan(accumulator, 2, 1, 0);
  see_misaligned_radar(accumulator);
  see_tracks(accumulator);
  see_labels(accumulator, 2, pipeline_flag::kNoTracks);
  ServiceStatus status{};
  status.header.source_id = 4;
  status.inputs = 12;
  status.faults[static_cast<std::size_t>(Fault::kCapacity)] = 3;
  status.faults[static_cast<std::size_t>(Fault::kInputDropped)] = 7;
  status.latency_max_us = 3456.0F;
  accumulator.observe(status);
  return accumulator.snapshot(123'456'789'012'345);
}

TEST(SnapshotLines, AreReadBackWithEveryValueAlsoWhenTheLastIsCutOff) {
  const Snapshot written = eventful_snapshot();
  const std::string whole = to_json(written) + to_json(written);
  std::istringstream all(whole), cut(whole.substr(0, whole.size() - 20));
  DamagedLines of_cut, of_all;
  EXPECT_EQ(read_snapshots(cut, "cut", of_cut).size(), 1U);
  EXPECT_EQ(of_cut.count, 1U);
  const auto snapshots = read_snapshots(all, "all", of_all);
  EXPECT_EQ(of_all.count, 0U) << of_all.first;
  ASSERT_EQ(snapshots.size(), 2U);
  EXPECT_EQ(to_json(snapshots[1]), to_json(written));
  EXPECT_EQ(snapshots[0].time_ns, written.time_ns);
  EXPECT_EQ(snapshots[0].services[4].faults, written.services[4].faults);
  EXPECT_EQ(snapshots[0].services[4].latency_max_us, 3456.0);
  EXPECT_EQ(snapshots[0].latencies[4].counts(), written.latencies[4].counts());
  EXPECT_EQ(snapshots[0].radars[1].conditions, written.radars[1].conditions);
  EXPECT_NEAR(snapshots[0].radars[1].details.pitch.value_rad, written.radars[1].details.pitch.value_rad, 1e-9);
  EXPECT_TRUE(std::isnan(snapshots[0].radars[1].details.pitch_seconds_to_95_percent));
  EXPECT_EQ(snapshots[0].overall, DataQualifier::kAvailableReduced);
  EXPECT_EQ(snapshots[0].pipeline.failed_events, written.pipeline.failed_events);
  EXPECT_EQ(snapshots[0].pipeline.queueing_max_ms, 12.5);
  EXPECT_EQ(snapshots[0].tracks[0].object_class, ObjectClass::kVan);
  EXPECT_EQ(snapshots[0].tracks[0].existence, 0.75);
  EXPECT_EQ(snapshots[0].tracks[0].mirror_probability, 0.125);
}

TEST(SnapshotLines, StateConditionsAnglesAndLabels) {
  const std::string line = to_json(eventful_snapshot());
  EXPECT_THAT(line, ::testing::EndsWith("}\n"));
  EXPECT_THAT(line, ::testing::HasSubstr(R"("missed":12,"suspect":3,"conditions":"partly blocked, unsynchronised")"));
  EXPECT_THAT(line, ::testing::HasSubstr(R"("vehicle_pitch_deg":{"value":-0.7)"));
  EXPECT_THAT(line, ::testing::HasSubstr(R"("pitch_seconds_to_95_percent":null)"));
  EXPECT_THAT(line,
              ::testing::HasSubstr(
                  R"("classified":{"unknown":0,"moving":2,"stationary":0,"ghost_type_1":0,"ghost_type_2":1,)"
                  R"("clutter":1,"ambiguity":0,"rejected":1},"classified_scans":1,"classified_without_tracks":1)"));
}

TEST(SnapshotLines, HoldTheVerdictOnThePipelineWithItsTroubleCodes) {
  EXPECT_THAT(to_json(eventful_snapshot()),
              ::testing::HasSubstr(R"("overall":"AVAILABLE_REDUCED","pipeline":{"data_qualifier":"AVAILABLE_REDUCED",)"
                                   R"("failed_events":["U1B00-82","U1B00-33"],"failed_event_bits":9,"lost_scans":7,)"
                                   R"("budget_hits":2,"queueing_max_ms":12.5,"latency_p99_ms":61.0})"));
}

TEST(SnapshotLines, NameOfARadarMayHoldAnyCharacter) {
  Snapshot written;
  written.radars.resize(1);
  written.radars[0].name = "front, \"left\" \\ Kühler\n</b>";
  std::istringstream lines(to_json(written));
  DamagedLines damaged;
  const auto snapshots = read_snapshots(lines, "r", damaged);
  ASSERT_EQ(snapshots.size(), 1U) << damaged.first;
  EXPECT_EQ(snapshots[0].radars[0].name, written.radars[0].name);
}

TEST(SnapshotLines, DamagedLineIsSkippedAndReportedWithFieldAndAllowedValues) {
  const std::string whole = to_json(eventful_snapshot());
  const struct {
    std::string from, to;
    const char* first;
  } cases[] = {
      {"{\"time_ns\":123456789012345", "{\"time_ns\":\"soon\"", "r:1: time_ns is '\"soon\"', allowed: a whole number"},
      {"\"x_m\":-10.0", "\"x_m\":\"far\"", "r:1: tracks[0].x_m is '\"far\"', allowed: a number"},
      {"\"x_m\":-10.0", "\"x\":-10.0", "r:1: tracks[0].x_m is missing"},
      {"{\"id\":8,\"confirmed\"", "{\"id\":4294967296,\"confirmed\"",
       "r:1: tracks[0].id is '4294967296', allowed: a whole number from 0 to 4294967295"},
      {"\"confirmed\":true", "\"confirmed\":1", "r:1: tracks[0].confirmed is '1', allowed: true or false"},
      {"\"tracks\":[", "\"tracks\":1,\"more\":[", "r:1: tracks is '1', allowed: an array"},
      {"\"buckets\":[[", "\"buckets\":[[4000000000,1],[", "r:1: latency_us.ingest.buckets is "},
      {"{\"time_ns\"", "\"time_ns\"", "r:1: the line is no JSON"},
  };
  for (const auto& c : cases) {
    std::string damaged_line = whole;
    const std::size_t at = damaged_line.find(c.from);
    ASSERT_NE(at, std::string::npos) << c.from;
    damaged_line.replace(at, c.from.size(), c.to);
    std::istringstream lines(damaged_line + whole);
    DamagedLines damaged;
    EXPECT_EQ(read_snapshots(lines, "r", damaged).size(), 1U) << "nothing else is lost: " << c.to;
    EXPECT_EQ(damaged.count, 1U) << c.to;
    EXPECT_THAT(damaged.first, ::testing::StartsWith(c.first));
  }
}

TEST(Render, ShowsWhichRadarIsMisalignedWithItsUncertainty) {
  Accumulator accumulator(vehicle());
  see_misaligned_radar(accumulator);
  see_tracks(accumulator);
  RenderOptions options;
  options.width = 190;
  const std::string screen = render_screen(accumulator.snapshot(0), options);
  EXPECT_THAT(screen, ::testing::HasSubstr("+2.500 ± 0.040°"));
  EXPECT_THAT(screen, ::testing::HasSubstr("AVAILABLE_REDUCED (MISALIGNED)"));
  EXPECT_THAT(
      screen,
      ::testing::HasSubstr(
          "\n             partly blocked, unsynchronised, 1 sudden misalignment, 12 scans lost or incomplete at "
          "the gateway, 3 scans of doubtful integrity\n"));
  EXPECT_THAT(screen, ::testing::HasSubstr("-0.700 ± 0.040°"));
  EXPECT_THAT(screen, ::testing::HasSubstr("not observable"));
  EXPECT_THAT(screen, ::testing::HasSubstr("1.4 s     +0.004°"));
  EXPECT_THAT(screen, ::testing::HasSubstr(
                          "yaw-rate bias +0.100 ± 0.020 °/s   slip coefficient of the rear axle not observable"));
  EXPECT_THAT(screen, ::testing::HasSubstr("1 confirmed, 1 tentative"));
  EXPECT_THAT(screen, ::testing::HasSubstr("10.0 m behind"));
  EXPECT_THAT(screen, ::testing::HasSubstr("restarted (1 restart)"));
  EXPECT_THAT(screen, ::testing::Not(::testing::HasSubstr("\x1b"))) << "no colour unless asked for";
  EXPECT_THAT(render_line(accumulator.snapshot(0), 3.0), ::testing::HasSubstr("front_right 0/s yaw +2.500 ± 0.040°"));
}

TEST(Render, ShowsTheVerdictOnThePipelineWithItsFiguresAndTroubleCodes) {
  Accumulator accumulator(vehicle());
  EXPECT_THAT(render_screen(accumulator.snapshot(0), {.width = 190}),
              ::testing::HasSubstr("\nHEALTH   NOT_AVAILABLE   pipeline NOT_AVAILABLE   0 scans lost"))
      << "nothing is available before the health service has reported";
  see_misaligned_radar(accumulator);
  const std::string screen = render_screen(accumulator.snapshot(0), {.width = 190});
  EXPECT_THAT(screen, ::testing::HasSubstr(
                          "\nHEALTH   AVAILABLE_REDUCED   pipeline AVAILABLE_REDUCED   7 scans lost   2 at the work "
                          "budget   queueing max 12.5 ms   latency p99 61.0 ms\n         U1B00-82 scans are lost or "
                          "dropped between the stages\n         U1B00-33 track lists come later"));
  EXPECT_THAT(render_line(accumulator.snapshot(0), 3.0),
              ::testing::HasSubstr("overall AVAILABLE_REDUCED, pipeline AVAILABLE_REDUCED U1B00-82 U1B00-33 | "));
}

TEST(Render, CutsLinesByCharactersNotBytes) {
  Accumulator accumulator(vehicle());
  see_misaligned_radar(accumulator);
  RenderOptions options;
  options.width = 60;
  std::istringstream screen(render_screen(accumulator.snapshot(0), options));
  for (std::string line; std::getline(screen, line);) {
    const auto characters = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    EXPECT_LE(characters, 60) << line;
    ASSERT_TRUE(line.empty() || (line.back() & 0xC0) != 0xC0) << "no character cut in half: " << line;
  }
}

}  // namespace
}  // namespace boresight::monitor
