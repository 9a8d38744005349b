// The check of range rates on simulated drives: valid scans are never suspect, damaged ones are reported.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/core/scan_integrity.hpp"
#include "services/simulator/drive.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

using namespace scan_integrity;

VehicleConfig demo() {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
}

using Damage = std::function<void(RadarScan&, std::mt19937_64&)>;

void scale_rates(RadarScan& scan, float by) {
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) scan.range_rate_mps[i] *= by;
}

void shuffle_rates(RadarScan& scan, std::mt19937_64& random) {
  std::shuffle(scan.range_rate_mps.data(), scan.range_rate_mps.data() + scan.number_of_valid_detections, random);
}

void mirror_azimuths(RadarScan& scan, std::mt19937_64&) {
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) scan.azimuth_rad[i] *= -1.0F;
}

/// Folds range rates into ±10 m/s, as a radar with that unambiguous interval does.
void fold_rates(RadarScan& scan) {
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    scan.range_rate_mps[i] = std::remainder(scan.range_rate_mps[i], 20.0F);
  }
  scan.fields |= scan_field::kAmbiguity;
  scan.range_rate_min_mps = -10.0F;
  scan.range_rate_max_mps = 10.0F;
}

using NamedDamage = std::pair<std::string, Damage>;

const std::vector<NamedDamage>& damages() {
  static const std::vector<NamedDamage> all = {
      {"shuffled", shuffle_rates},
      {"half as fast again", [](RadarScan& scan, std::mt19937_64&) { scale_rates(scan, 1.5F); }},
      {"too slow", [](RadarScan& scan, std::mt19937_64&) { scale_rates(scan, 0.7F); }},
      {"sign", [](RadarScan& scan, std::mt19937_64&) { scale_rates(scan, -1.0F); }},
      {"zero", [](RadarScan& scan, std::mt19937_64&) { scale_rates(scan, 0.0F); }},
      {"left and right", mirror_azimuths},
      {"sign, folded",
       [](RadarScan& scan, std::mt19937_64&) {
         scale_rates(scan, -1.0F);
         fold_rates(scan);
       }},
  };
  return all;
}

struct JudgedRadar {
  explicit JudgedRadar(const RadarConfig& radar) : judge(radar) {}
  ScanJudge judge;
  std::vector<bool> accused;         // of each scan: contradicts the vehicle's motion
  std::uint64_t driven = 0;          // scans above 5 m/s; below, the motion is not tested
  std::uint64_t surely_damaged = 0;  // of these, those in which the damage can be nothing else
};
using JudgedRadars = std::map<std::uint32_t, std::unique_ptr<JudgedRadar>>;

/// Checks all radars of the demo vehicle on one simulated drive, for each kind of damage.
std::vector<JudgedRadars> drive(const simulator::Scenario& scenario, std::uint64_t seed, double duration_s,
                                const std::vector<NamedDamage>& kinds, const VehicleConfig& vehicle = demo()) {
  std::vector<JudgedRadars> judged(kinds.size());
  for (JudgedRadars& radars : judged) {
    for (const RadarConfig& radar : vehicle.radars) radars[radar.id] = std::make_unique<JudgedRadar>(radar);
  }
  std::mt19937_64 random(seed);
  simulator::Drive drive(scenario, vehicle, seed, duration_s);
  const auto scan = std::make_unique<RadarScan>();
  EgoMotion ego{};
  while (const simulator::Event* const event = drive.next()) {
    if (event->scan == nullptr) {
      ego = simulator::to_message(*event, vehicle.ego);
      ego.header.measurement_time_ns = event->time_ns;
      continue;
    }
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      *scan = *event->scan;
      scan->integrity = 0;
      if (kinds[k].second) kinds[k].second(*scan, random);
      JudgedRadar& radar = *judged[k][scan->header.source_id];
      // Without a signal of the direction of travel, other signs below `fastest_reverse_mps` are those of reversing.
      const float sure_mps = kinds[k].first.starts_with("sign") ? 10.0F : 5.0F;
      radar.driven += std::abs(ego.speed_mps) > 5.0F ? 1 : 0;
      radar.surely_damaged += std::abs(ego.speed_mps) > sure_mps ? 1 : 0;
      const auto verdict = radar.judge.judge(*scan, event->time_ns, event->time_ns + 20 * kMillisecond, 32, &ego);
      radar.accused.push_back((verdict & kContradictsEgo) != 0);
    }
  }
  return judged;
}

class SimulatedDrive : public testing::TestWithParam<std::string> {};

TEST_P(SimulatedDrive, ValidScansAreNeverSuspect) {
  // Misaligned radars, a wrong speed signal, moving objects, ghosts and clutter are valid data. So are range rates
  // folded into a known interval.
  const std::vector<NamedDamage> none = {{"as measured", nullptr},
                                         {"folded", [](RadarScan& scan, std::mt19937_64&) { fold_rates(scan); }}};
  for (const std::uint64_t seed : {1u, 4u}) {
    const auto judged = drive(simulator::scenario(GetParam()), seed, 25.0, none);
    for (std::size_t k = 0; k < none.size(); ++k) {
      for (const auto& [id, radar] : judged[k]) {
        const IntegrityCounters& counters = radar->judge.counters();
        EXPECT_GT(counters.scans, 450u);
        EXPECT_EQ(counters.lost_scans, 0u);
        for (const std::uint64_t suspect : counters.by_bit) EXPECT_EQ(suspect, 0u) << none[k].first << ", radar " << id;
      }
    }
  }
}

TEST_P(SimulatedDrive, DamagedRangeRatesAreReportedForEveryRadarWithinSeconds) {
  const auto judged = drive(simulator::scenario(GetParam()), 5, 25.0, damages());
  for (std::size_t k = 0; k < judged.size(); ++k) {
    for (const auto& [id, radar] : judged[k]) {
      const std::uint64_t reported = radar->judge.counters().by_bit[5];
      // None in the parking garage: at these speeds, damage looks like slow moving objects.
      // Where most detections have similar range rates, as in a tunnel or a street, shuffled ones differ little.
      EXPECT_GE(reported, radar->surely_damaged / (damages()[k].first == "shuffled" ? 7 : 2))
          << damages()[k].first << ", radar " << id;
      EXPECT_LT(reported, radar->driven - std::min<std::uint64_t>(radar->driven, 2) + 1) << "not by a single scan";
    }
  }
}

/// As of a radar that looks 35° further to the left than the vehicle file states.
void turn_azimuths(RadarScan& scan, std::mt19937_64&) {
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    scan.azimuth_rad[i] += 0.6F;
    if (scan.azimuth_rad[i] > 1.2F) scan.detection_flags[i] |= detection_flag::kInvalid;
  }
}

/// Damages the scans of each radar from that number on until the other one.
NamedDamage between(std::size_t begin, std::size_t end, const Damage& damage) {
  const auto scans = std::make_shared<std::map<std::uint32_t, std::size_t>>();
  return {"for some time", [=](RadarScan& scan, std::mt19937_64& random) {
            const std::size_t number = (*scans)[scan.header.source_id]++;
            if (number >= begin && number < end) damage(scan, random);
          }};
}

std::size_t accused_between(const JudgedRadar& radar, std::size_t begin, std::size_t end) {
  return static_cast<std::size_t>(std::count(radar.accused.begin() + static_cast<std::ptrdiff_t>(begin),
                                             radar.accused.begin() + static_cast<std::ptrdiff_t>(end), true));
}

TEST(SequentialDecision, AMirroredRadarIsDistrustedWithinAFifthOfASecondAndASoundOneAgainWithinTwoSeconds) {
  for (const char* const scenario : {"aligned_drive", "tunnel", "truck_overtaking", "demo_drive"}) {
    const auto judged = drive(simulator::scenario(scenario), 11, 25.0, {between(200, 400, mirror_azimuths)});
    for (const auto& [id, radar] : judged.front()) {
      EXPECT_EQ(accused_between(*radar, 0, 200), 0u) << scenario << ", radar " << id;
      EXPECT_EQ(accused_between(*radar, 204, 400), 196u) << scenario << ", radar " << id;
      EXPECT_EQ(accused_between(*radar, 440, radar->accused.size()), 0u) << scenario << ", radar " << id;
    }
  }
}

TEST(SequentialDecision, ShuffledRangeRatesAreFoundWithinFiveSecondsAndSoundOnesAgain) {
  for (const char* const scenario : {"aligned_drive", "demo_drive"}) {
    const auto judged = drive(simulator::scenario(scenario), 11, 25.0, {between(200, 400, shuffle_rates)});
    for (const auto& [id, radar] : judged.front()) {
      EXPECT_EQ(accused_between(*radar, 0, 200), 0u) << scenario << ", radar " << id;
      EXPECT_GE(accused_between(*radar, 300, 400), 90u) << scenario << ", radar " << id;
      EXPECT_EQ(accused_between(*radar, 450, radar->accused.size()), 0u) << scenario << ", radar " << id;
    }
  }
}

TEST(SequentialDecision, AnotherDirectionThatNoAlternativeNamesIsFoundWithinThreeSeconds) {
  for (const char* const scenario : {"aligned_drive", "demo_drive"}) {
    const auto judged = drive(simulator::scenario(scenario), 11, 20.0, {between(200, 400, turn_azimuths)});
    for (const auto& [id, radar] : judged.front()) {
      EXPECT_EQ(accused_between(*radar, 0, 200), 0u) << scenario << ", radar " << id;
      EXPECT_GE(accused_between(*radar, 260, 400), 130u) << scenario << ", radar " << id;
    }
  }
}

TEST(SequentialDecision, MirroringARadarThatLooksStraightAheadIsNotFound) {
  // A limit: about the direction of travel, both signs of the azimuth predict the same range rates.
  VehicleConfig vehicle = demo();
  vehicle.radars.resize(1);
  vehicle.radars.front().mounting_pose.yaw_rad = 0.0;
  vehicle.radars.front().mounting_pose.position_m = {3.7, 0.0, 0.6};
  const auto judged =
      drive(simulator::scenario("straight_rail"), 11, 15.0, {between(100, 300, mirror_azimuths)}, vehicle);
  EXPECT_EQ(judged.front().at(vehicle.radars.front().id)->judge.counters().by_bit[5], 0u);
}

INSTANTIATE_TEST_SUITE_P(All, SimulatedDrive, testing::ValuesIn(simulator::scenario_names()));

TEST(ScanJudge, MisalignedByEightDegreesAndFivePercentIsNoContradiction) {
  for (const double yaw_deg : {-8.0, 8.0}) {
    for (const double speed_scale : {0.96, 1.04}) {
      simulator::Scenario scenario = simulator::scenario("demo_drive");
      scenario.effects.speed_scale = speed_scale;
      for (auto& misalignment : scenario.effects.misalignment) misalignment.yaw_rad = yaw_deg * M_PI / 180.0;
      const auto judged = drive(scenario, 6, 30.0, {{"none", nullptr}});
      for (const auto& [id, radar] : judged.front()) {
        EXPECT_EQ(radar->judge.counters().by_bit[5], 0u) << yaw_deg << ' ' << speed_scale << " radar " << id;
      }
    }
  }
}

}  // namespace
}  // namespace boresight::ingest
