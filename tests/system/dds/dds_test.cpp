// Reports of the health service arrive by DDS at our own reader.
#include <filesystem>
#include <map>
#include <mutex>

#include <gtest/gtest.h>

#include "services/health/dds/diagnostics_reader.hpp"
#include "services/health/dds/diagnostics_writer.hpp"
#include "tests/system/dds/samples.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::dds {
namespace {

namespace fs = std::filesystem;

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

TEST(Dds, EveryRadarOfALargeVehicleArrives) {
  HealthReport many = report();
  many.number_of_sensors = kMaxRadars;
  for (std::uint32_t i = 0; i < kMaxRadars; ++i) many.sensors[i].radar_id = i + 1;
  Participant participant(kConfig, "test");
  DiagnosticsWriter writer(participant, vehicle());
  ASSERT_TRUE(writer.write(many, kTime_ns)) << "the middleware's default is ten instances";
  Received received;
  const DiagnosticsReader reader(kConfig, received.callbacks);
  EXPECT_TRUE(harness::eventually(10.0, [&] {
    const std::lock_guard lock(received.mutex);
    return received.sensors.size() == kMaxRadars;
  }));
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

}  // namespace
}  // namespace boresight::dds
