// Reports of the health service arrive by DDS at our own reader and at another implementation's.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>

#include <gtest/gtest.h>

#include "interfaces/messages/service_status.hpp"
#include "services/boresight/diagnostics/diagnostics_text.hpp"
#include "services/health/dds/diagnostics_reader.hpp"
#include "services/health/dds/diagnostics_writer.hpp"
#include "services/health/dds/system_health.hpp"
#include "services/health/dds/to_dds.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::dds {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kTime_ns = 1'700'000'000'250'000'000;
const Config kConfig{.domain = 77, .command_key_file = {}};

VehicleConfig vehicle() {
  VehicleConfig v;
  v.name = "test car";
  for (const auto& [id, name] : {std::pair{1u, "front_left"}, std::pair{2u, "front_right"}}) {
    RadarConfig radar;
    radar.id = id;
    radar.name = name;
    v.radars.push_back(radar);
  }
  return v;
}

HealthReport report() {
  HealthReport r{};
  r.overall = DataQualifier::kAvailableReduced;
  r.number_of_sensors = 2;
  r.number_of_services = 6;
  r.latency_p50_ms = 0.5F;
  r.latency_max_ms = 7.5F;
  r.stored_events = 4;
  r.pipeline = {.data_qualifier = DataQualifier::kAvailableReduced,
                .reserved = {},
                .failed_events = 1u << static_cast<unsigned>(PipelineEvent::kLosing) |
                                 1u << static_cast<unsigned>(PipelineEvent::kLate),
                .lost_scans = 12,
                .budget_hits = 3,
                .queueing_max_ms = 31.5F,
                .latency_p99_ms = 62.5F};
  for (std::uint32_t i = 0; i < 6; ++i) {
    r.services[i].service = i;
    r.services[i].condition = ServiceCondition::kAlive;
  }
  r.services[4].condition = ServiceCondition::kSilent;
  r.sensors[0].radar_id = 1;
  SensorHealth& misaligned = r.sensors[1];
  misaligned.radar_id = 2;
  misaligned.data_qualifier = DataQualifier::kAvailableReduced;
  misaligned.extended_qualifier = ExtendedQualifier::kMisaligned;
  misaligned.rate_hz = 20.0F;
  misaligned.yaw.error_rad = 0.0436F;
  misaligned.yaw.std_rad = 0.0004F;
  misaligned.yaw.tolerance_rad = 0.0262F;
  misaligned.yaw.limit_rad = 0.0524F;
  misaligned.yaw.beyond_tolerance_probability = 1.0F;
  misaligned.yaw.beyond_limit_probability = 0.25F;
  misaligned.yaw.effect = AxisEffect::kReduced;
  misaligned.yaw.observable = misaligned.yaw.beyond_tolerance = 1;
  misaligned.speed_scale = 1.012F;
  misaligned.lateral_displacement_m = 4.36F;
  misaligned.reference_range_m = 100.0F;
  misaligned.lost_coverage_ratio = 0.031F;
  misaligned.range_loss_ratio = 0.012F;
  misaligned.velocity_error_mps = 0.61F;
  misaligned.scans = 12'345'678'901ULL;
  misaligned.missed_scans = 23'456'789'012ULL;
  misaligned.suspect_scans = 34;
  misaligned.e2e_lost = 5;
  misaligned.e2e_repeated = 6;
  misaligned.e2e_wrong = 7;
  misaligned.step_changes = 3;
  misaligned.range_rate_scale = {0.0025F, 0.0004F};
  misaligned.drift = {1'500'000'000, 1e-5F, 1e-6F, -2e-5F, 2e-6F};
  r.load_change = {2'500'000'000, 0.0136F, 1};
  r.speed_change = {3'500'000'000, -0.012F, 2};
  misaligned.conditions = source_condition::kSupply | source_condition::kWithoutEgoMotion;
  return r;
}

/// The latest sample of each radar, and the latest array.
struct Received {
  std::mutex mutex;
  std::map<std::uint32_t, diagnostics::SensorHealth> sensors;
  std::size_t samples = 0;
  diagnostic_msgs::msg::dds_::DiagnosticArray_ array;
  diagnostics::SystemHealth system;

  DiagnosticsCallbacks callbacks{.on_sensor_health =
                                     [this](const diagnostics::SensorHealth& s) {
                                       const std::lock_guard lock(mutex);
                                       sensors[s.radar_id()] = s;
                                       ++samples;
                                     },
                                 .on_system_health =
                                     [this](const diagnostics::SystemHealth& s) {
                                       const std::lock_guard lock(mutex);
                                       system = s;
                                     },
                                 .on_diagnostic_array =
                                     [this](const diagnostic_msgs::msg::dds_::DiagnosticArray_& a) {
                                       const std::lock_guard lock(mutex);
                                       array = a;
                                     },
                                 .on_presence = {}};
  bool is_complete() {
    const std::lock_guard lock(mutex);
    return sensors.size() == 2 && !array.status_().empty() && !system.vehicle_name().empty();
  }
};

TEST(Dds, EveryFieldArrivesAndALateReaderGetsTheLatestState) {
  Participant participant(kConfig, "test");
  DiagnosticsWriter writer(participant, vehicle());
  HealthReport old = report();
  old.sensors[1].extended_qualifier = ExtendedQualifier::kNoData;
  ASSERT_TRUE(writer.write(old, kTime_ns - 1'000'000'000));
  ASSERT_TRUE(writer.write(report(), kTime_ns));
  // The reader starts after the writing.
  Received received;
  const DiagnosticsReader reader(kConfig, received.callbacks);
  ASSERT_TRUE(harness::eventually(10.0, [&] { return received.is_complete(); })) << "no sample arrived";
  const std::lock_guard lock(received.mutex);
  EXPECT_EQ(received.samples, 2u) << "one instance a radar, the latest only";
  const diagnostics::SensorHealth& s = received.sensors.at(2);
  EXPECT_EQ(s.radar_name(), "front_right");
  EXPECT_EQ(s.vehicle_name(), "test car");
  EXPECT_EQ(s.time_ns(), kTime_ns);
  EXPECT_EQ(s.data_qualifier(), diagnostics::AVAILABLE_REDUCED);
  EXPECT_EQ(s.extended_qualifier(), diagnostics::MISALIGNED);
  EXPECT_EQ(s.yaw().error_rad(), 0.0436F);
  EXPECT_TRUE(s.yaw().observable());
  EXPECT_TRUE(s.yaw().beyond_tolerance());
  EXPECT_EQ(s.yaw().limit_rad(), 0.0524F);
  EXPECT_EQ(s.yaw().beyond_tolerance_probability(), 1.0F);
  EXPECT_EQ(s.yaw().beyond_limit_probability(), 0.25F);
  EXPECT_EQ(s.yaw().effect(), diagnostics::EFFECT_REDUCED);
  EXPECT_FALSE(s.pitch().observable());
  EXPECT_EQ(s.pitch().effect(), diagnostics::EFFECT_UNKNOWN);
  EXPECT_EQ(s.explanation().find("yaw +2.498 ± 0.023°, reduced: beyond 1.5°; 4.4 m at 100 m, 3 % of"), 0U)
      << s.explanation();
  EXPECT_EQ(s.alignment_reason(), "none");
  EXPECT_EQ(s.finding(), "none");
  EXPECT_EQ(s.range_rate_scale(), 0.0025F);
  EXPECT_EQ(s.range_rate_scale_std(), 0.0004F);
  EXPECT_EQ(s.step_changes(), 3U);
  EXPECT_EQ(s.drift().since_ns(), 1'500'000'000);
  EXPECT_EQ(s.drift().pitch_radps(), -2e-5F);
  EXPECT_EQ(s.load_change().time_ns(), 2'500'000'000);
  EXPECT_EQ(s.load_change().size(), 0.0136F);
  EXPECT_EQ(s.speed_change().count(), 2U);
  EXPECT_EQ(s.scans(), 12'345'678'901ULL);
  EXPECT_EQ(s.missed_scans(), 23'456'789'012ULL);
  EXPECT_EQ(s.suspect_scans(), 34u);
  EXPECT_EQ(s.e2e_lost(), 5u);
  EXPECT_EQ(s.e2e_repeated(), 6u);
  EXPECT_EQ(s.e2e_wrong(), 7u);
  EXPECT_EQ(s.conditions(), source_condition::kSupply | source_condition::kWithoutEgoMotion);
  EXPECT_EQ(s.lateral_displacement_m(), 4.36F);
  EXPECT_EQ(s.lost_coverage_ratio(), 0.031F);
  EXPECT_EQ(s.range_loss_ratio(), 0.012F);
  EXPECT_EQ(s.velocity_error_mps(), 0.61F);
  const diagnostics::SystemHealth& system = received.system;
  EXPECT_EQ(system.vehicle_name(), "test car");
  EXPECT_EQ(system.time_ns(), kTime_ns);
  EXPECT_EQ(system.overall(), diagnostics::AVAILABLE_REDUCED);
  EXPECT_EQ(system.pipeline().data_qualifier(), diagnostics::AVAILABLE_REDUCED);
  EXPECT_EQ(system.pipeline().trouble_codes(), "U1B00-82 U1B00-33");
  EXPECT_EQ(system.pipeline().lost_scans(), 12u);
  EXPECT_EQ(system.pipeline().budget_hits(), 3u);
  EXPECT_EQ(system.pipeline().queueing_max_ms(), 31.5F);
  EXPECT_EQ(system.pipeline().latency_p99_ms(), 62.5F);
  EXPECT_EQ(system.services(),
            "ingest_gateway:alive alignment_estimator:alive detection_corrector:alive ghost_filter:alive "
            "tracker:silent health:alive");
  EXPECT_EQ(system.latency_p50_ms(), 0.5F);
  EXPECT_EQ(system.latency_max_ms(), 7.5F);
  EXPECT_EQ(system.stored_trouble_codes(), 4u);
  ASSERT_EQ(received.array.status_().size(), 1u + 2u + 6u);
  const auto& statuses = received.array.status_();
  EXPECT_EQ(received.array.header_().stamp_().sec_(), 1'700'000'000);
  EXPECT_EQ(received.array.header_().stamp_().nanosec_(), 250'000'000u);
  EXPECT_EQ(statuses[0].name_(), "boresight");
  EXPECT_EQ(statuses[0].level_(), 1);
  EXPECT_EQ(statuses[1].level_(), 0);
  EXPECT_EQ(statuses[2].name_(), "boresight/radar/front_right");
  EXPECT_EQ(statuses[2].message_().find("AVAILABLE_REDUCED MISALIGNED: yaw +2.498 ± 0.023°, reduced: beyond 1.5°"), 0U)
      << statuses[2].message_();
  EXPECT_EQ(statuses[2].level_(), 1);
  std::map<std::string, std::string> values;
  for (const auto& value : statuses[0].values_()) values[value.key_()] = value.value_();
  EXPECT_EQ(values["pipeline"], "AVAILABLE_REDUCED");
  EXPECT_EQ(values["pipeline trouble codes"], "U1B00-82 U1B00-33");
  EXPECT_EQ(values["lost scans"], "12");
  EXPECT_EQ(values["longest queueing"], "31.500 ms");
  for (const auto& value : statuses[2].values_()) values[value.key_()] = value.value_();
  EXPECT_EQ(values["reported by the sensor"], "supply, without ego motion");
  EXPECT_EQ(values["scans lost before the gateway"], "23456789012");
  EXPECT_EQ(values["suspect scans"], "34");
  EXPECT_EQ(statuses[7].name_(), "boresight/service/tracker");
  EXPECT_EQ(statuses[7].level_(), 3) << "silent";
}

TEST(Dds, LeavesNothingInSharedMemory) {
  {
    Participant participant(kConfig, "test");
    DiagnosticsWriter writer(participant, vehicle());
    Received received;
    const DiagnosticsReader reader(kConfig, received.callbacks);
    ASSERT_TRUE(writer.write(report(), kTime_ns));
    EXPECT_TRUE(harness::eventually(10.0, [&] { return received.is_complete(); }));
    EXPECT_TRUE(fs::is_empty("/dev/shm")) << "UDP only";
  }
  EXPECT_TRUE(fs::is_empty("/dev/shm"));
}

TEST(Dds, OtherDomainsReceiveNothing) {
  Participant participant(kConfig, "test");
  DiagnosticsWriter writer(participant, vehicle());
  Received received;
  Config other = kConfig;
  other.domain = 78;
  const DiagnosticsReader reader(other, received.callbacks);
  ASSERT_TRUE(writer.write(report(), kTime_ns));
  EXPECT_FALSE(harness::eventually(1.0, [&] { return received.is_complete(); }));
}

TEST(Dds, AnotherImplementationReadsTheTopics) {
  if (!fs::exists(BORESIGHT_PEER)) GTEST_SKIP() << "skipped: Cyclone DDS is not installed";
  Participant participant(kConfig, "test");
  DiagnosticsWriter writer(participant, vehicle());
  ASSERT_TRUE(writer.write(report(), kTime_ns));
  FILE* const pipe = popen(BORESIGHT_PEER " 77 15", "r");
  ASSERT_NE(pipe, nullptr);
  std::string output;
  std::array<char, 256> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
  EXPECT_EQ(pclose(pipe), 0) << output;
  EXPECT_NE(output.find("status 1 boresight/radar/front_right: AVAILABLE_REDUCED MISALIGNED"), std::string::npos)
      << output;
  EXPECT_NE(output.find("status 3 boresight/service/tracker: silent"), std::string::npos) << output;
  EXPECT_NE(output.find("system test car 1 pipeline 1 U1B00-82 U1B00-33 lost 12"), std::string::npos) << output;
  EXPECT_NE(output.find("sensor 2 front_right 1 1 yaw 0.0436 suspect 34 conditions 72"), std::string::npos) << output;
}

TEST(DiagnosticsText, StatesAWrongInputInOneSentence) {
  HealthReport with_finding = report();
  SensorHealth& swapped = with_finding.sensors[1];
  swapped.yaw.beyond_tolerance = 0;
  swapped.extended_qualifier = ExtendedQualifier::kWrongInput;
  swapped.reason = AlignmentReason::kWrongInput;
  swapped.finding = AlignmentFinding::kSpeedUnit;
  swapped.finding_value = 3.6F;
  const diagnostics::SensorHealth s = to_sensor_health(with_finding, 1, vehicle(), kTime_ns);
  EXPECT_EQ(s.extended_qualifier(), diagnostics::WRONG_INPUT);
  EXPECT_EQ(s.finding(), "speed_unit");
  const std::string line = diagnostics_text::to_line(s);
  EXPECT_NE(line.find("AVAILABLE_REDUCED WRONG_INPUT"), std::string::npos) << line;
  EXPECT_NE(line.find("speed signal in km/h (3.6 times too large)"), std::string::npos) << line;
  EXPECT_NE(line.find("load changed the vehicle's pitch by +0.78° (nose up)"), std::string::npos) << line;
}

TEST(DiagnosticsText, StatesTheSystemInOneLine) {
  const std::string line = diagnostics_text::to_line(to_system_health(report(), vehicle(), kTime_ns));
  EXPECT_NE(line.find(" system       AVAILABLE_REDUCED  pipeline AVAILABLE_REDUCED  12 scans lost  3 scans at a work "
                      "budget  queueing 31.5 ms  latency p99 62.5 ms  tracker:silent  U1B00-82 U1B00-33"),
            std::string::npos)
      << line;
}

TEST(DiagnosticsText, StatesVerdictErrorsAndDisplacement) {
  const diagnostics::SensorHealth s = to_sensor_health(report(), 1, vehicle(), kTime_ns);
  const std::string line = diagnostics_text::to_line(s);
  for (const char* part :
       {"front_right", "AVAILABLE_REDUCED MISALIGNED", "yaw +2.498 ± 0.023° (reduced, beyond 1.50°)",
        "lost coverage 3.1 %  loss of range 1.2 %  velocity error 0.61 m/s", "lateral displacement +4.36 m at 100 m",
        "20.0 Hz", "reported by the sensor: supply, without ego motion"}) {
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
  }
  EXPECT_EQ(line.find("  pitch "), std::string::npos) << "not observable: " << line;
  const std::string json = diagnostics_text::to_json(s);
  EXPECT_NE(json.find(R"("radar":"front_right")"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("extended_qualifier":"MISALIGNED")"), std::string::npos) << json;
  EXPECT_NE(
      json.find(
          R"("suspect_scans":34,"e2e_lost":5,"e2e_repeated":6,"e2e_wrong":7,"conditions":"supply, without ego motion"})"),
      std::string::npos)
      << json;
  const auto array = to_diagnostic_array(report(), vehicle(), kTime_ns);
  const std::string lines = diagnostics_text::to_lines(array);
  EXPECT_NE(lines.find("WARN  boresight/radar/front_right: AVAILABLE_REDUCED MISALIGNED"), std::string::npos) << lines;
  EXPECT_NE(lines.find("STALE boresight/service/tracker: silent"), std::string::npos) << lines;
  EXPECT_EQ(lines.find("front_left"), std::string::npos) << "statuses that are OK are not listed";
}

}  // namespace
}  // namespace boresight::dds
