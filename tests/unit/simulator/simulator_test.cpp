#include <cmath>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

#include "interfaces/messages/service_status.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/codecs/ars548.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/wire/ars548_encoder.hpp"

namespace boresight::simulator {
namespace {

VehicleConfig demo() {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
}

/// Sums up all events of a drive, so that two drives can be compared.
struct Digest {
  std::size_t scans = 0, egos = 0, detections = 0;
  double sum = 0.0;
  bool operator==(const Digest&) const = default;
};

Digest digest(const Scenario& scenario, const VehicleConfig& vehicle, std::uint64_t seed,
              std::uint32_t only_radar = 0) {
  Drive drive(scenario, vehicle, seed, 4.0);
  Digest d;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) {
      ++d.egos;
      d.sum += event->ego.speed_mps + event->ego.yaw_rate_radps;
      continue;
    }
    if (only_radar != 0 && event->scan->header.source_id != only_radar) continue;
    ++d.scans;
    d.detections += event->scan->number_of_valid_detections;
    for (std::size_t i = 0; i < event->scan->number_of_valid_detections; ++i) {
      d.sum += event->scan->range_m[i] + event->scan->azimuth_rad[i] + event->scan->range_rate_mps[i];
    }
  }
  return d;
}

TEST(Simulator, TheSameSeedIsTheSameDriveAndAnotherIsNot) {
  const Digest a = digest(scenario("demo_drive"), demo(), 5);
  EXPECT_EQ(a, digest(scenario("demo_drive"), demo(), 5));
  EXPECT_FALSE(a == digest(scenario("demo_drive"), demo(), 6));
  EXPECT_GE(a.scans, 4 * 79u);
  EXPECT_EQ(a.egos, 321u);
}

TEST(Simulator, ARadarSeesTheSameWhateverTheOthersSee) {
  VehicleConfig alone = demo();
  for (RadarConfig& radar : alone.radars) {
    if (radar.id != 2) radar.field_of_view.range_max_m = 1.0;
  }
  const Digest with = digest(scenario("demo_drive"), demo(), 5, 2),
               without = digest(scenario("demo_drive"), alone, 5, 2);
  EXPECT_EQ(with.detections, without.detections);
  EXPECT_EQ(with.scans, without.scans);
}

TEST(Simulator, WithoutNoiseStationaryPointsHaveTheRangeRateOfTheTruth) {
  Scenario quiet = scenario("demo_drive");
  quiet.effects.noise = false;
  quiet.effects.clutter_per_scan = 0.0;
  quiet.effects.resolution = {0.0, 0.0, 0.0};     // a centroid lies between points
  quiet.effects.multipath.ground_bounce = false;  // the ground changes the apparent elevation
  const VehicleConfig vehicle = demo();
  Drive drive(quiet, vehicle, 1, 3.0);
  std::size_t compared = 0;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    const RadarScan& scan = *event->scan;
    const RadarConfig& radar = *vehicle.radar(scan.header.source_id);
    const Misalignment& m = quiet.effects.misalignment[radar.id];
    const EgoState ego = drive.ego(event->t_s);
    const Eigen::Matrix3d rotation =
        geometry::sensor_to_vehicle(radar.mounting_pose, m.yaw_rad, m.pitch_rad, m.roll_rad);
    const Eigen::Vector3d velocity =
        geometry::sensor_velocity(1.0, ego.speed_mps, ego.yaw_rate_radps, radar.mounting_pose.position_m);
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      if ((*event->truth)[i].provenance != Provenance::kStationary) continue;
      const Eigen::Vector3d u = rotation * geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]);
      ASSERT_NEAR(scan.range_rate_mps[i], -u.dot(velocity), 1e-3);
      ++compared;
    }
  }
  EXPECT_GT(compared, 2000u);
}

TEST(Simulator, TheSpeedSignalDiffersByTheScaleOnly) {
  Scenario quiet = scenario("demo_drive");
  quiet.effects.noise = false;
  Drive drive(quiet, demo(), 1, 3.0);
  while (const Event* event = drive.next()) {
    if (event->scan != nullptr) continue;
    const EgoState ego = drive.ego(event->t_s);
    ASSERT_NEAR(event->ego.speed_mps * quiet.effects.speed_scale, ego.speed_mps, 1e-9);
    ASSERT_NEAR(event->ego.yaw_rate_radps, ego.yaw_rate_radps, 1e-9);
  }
}

TEST(Simulator, TruthNamesEveryKindOfDetection) {
  Drive drive(scenario("demo_drive"), demo(), 1, 20.0);
  std::array<std::size_t, kNumberOfProvenances> kinds{};
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    ASSERT_EQ(event->truth->size(), event->scan->number_of_valid_detections);
    for (const DetectionTruth& truth : *event->truth) ++kinds[static_cast<std::size_t>(truth.provenance)];
  }
  for (const Provenance p : {Provenance::kMoving, Provenance::kStationary, Provenance::kGhostType1,
                             Provenance::kGhostType2, Provenance::kClutter}) {
    EXPECT_GT(kinds[static_cast<std::size_t>(p)], 50u) << static_cast<int>(p);
  }
  EXPECT_EQ(kinds[static_cast<std::size_t>(Provenance::kUnknown)], 0u);
}

TEST(Simulator, ABlockedRadarReportsBlockageAndDetectsLess) {
  Scenario blocked = scenario("straight_rail");
  blocked.effects.blockages = {{1, 1.0, 2.0, 40.0, -3.2, 3.2}};
  Drive drive(blocked, demo(), 1, 3.0);
  std::size_t before = 0, after = 0;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    if (event->scan->header.source_id != 1) {
      EXPECT_EQ(event->condition, 0u);
      continue;
    }
    if (event->t_s < 1.0) {
      EXPECT_EQ(event->condition, 0u);
      before += event->scan->number_of_valid_detections;
    } else if (event->t_s > 2.0) {
      EXPECT_EQ(event->condition, source_condition::kBlocked);
      after += event->scan->number_of_valid_detections;
    }
  }
  EXPECT_LT(4 * after, before);
}

TEST(Simulator, TheWireFormatHoldsEveryScan) {
  Drive drive(scenario("demo_drive"), demo(), 3, 2.0);
  const auto bytes = std::make_unique<wire::Ars548List>();
  const auto decoded = std::make_unique<RadarScan>();
  std::size_t scans = 0;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    wire::encode_ars548(*event->scan, event->time_ns, *bytes);
    std::string_view problem;
    ASSERT_EQ(ingest::ars548::check(*bytes, problem), ingest::DecodeResult::kComplete) << problem;
    EXPECT_EQ(ingest::ars548::decode(*bytes, *decoded).time_ns, event->time_ns);
    const std::size_t count = event->scan->number_of_valid_detections;
    ASSERT_EQ(decoded->number_of_valid_detections, count);
    EXPECT_EQ(std::memcmp(decoded->range_m.data(), event->scan->range_m.data(), count * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(decoded->range_rate_mps.data(), event->scan->range_rate_mps.data(), count * sizeof(float)),
              0);
    ++scans;
  }
  EXPECT_GT(scans, 150u);
}

TEST(Simulator, AnUnknownScenarioIsNamedWithTheKnownOnes) {
  try {
    static_cast<void>(scenario("nowhere"));
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("demo_drive"), std::string::npos);
  }
}

}  // namespace
}  // namespace boresight::simulator
