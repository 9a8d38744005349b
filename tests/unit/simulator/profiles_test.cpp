// Every shipped scenario runs with every shipped profile. `ideal` is wave propagation alone, as before profiles.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/codecs/ars548.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/drive_writer.hpp"
#include "services/simulator/scenario/read_profile.hpp"

namespace boresight::simulator {
namespace {

namespace fs = std::filesystem;

VehicleConfig vehicle_of(const Scenario& scenario) {
  return config::read_vehicle_file(fs::path(BORESIGHT_SOURCE_DIR) / "config/vehicle" / (scenario.vehicle + ".toml"));
}

Scenario scenario_with(const std::string& name, const std::string& profile) {
  Scenario s = scenario(name);
  use_profile(s, profile);
  return s;
}

/// Sums over all detections of a drive.
struct Sums {
  std::size_t detections = 0;
  double range_m = 0.0, azimuth_rad = 0.0, range_rate_mps = 0.0, rcs_dbsm = 0.0;
  std::map<Cause, std::size_t> causes;
  bool sound = true;
};

Sums sums_of(const Scenario& scenario, double duration_s) {
  Drive drive(scenario, vehicle_of(scenario), 3, duration_s);
  Sums sums;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    const RadarScan& scan = *event->scan;
    sums.detections += event->truth->size();
    for (std::size_t i = 0; i < event->truth->size(); ++i) {
      sums.range_m += static_cast<double>(scan.range_m[i]);
      sums.azimuth_rad += static_cast<double>(scan.azimuth_rad[i]);
      sums.range_rate_mps += static_cast<double>(scan.range_rate_mps[i]);
      sums.rcs_dbsm += static_cast<double>(scan.rcs_dbsm[i]);
      ++sums.causes[(*event->truth)[i].cause];
      sums.sound = sums.sound && scan.range_m[i] > 0.0F && std::abs(scan.azimuth_rad[i]) < 1.6F &&
                   std::abs(scan.range_rate_mps[i]) < 150.0F && std::abs(scan.rcs_dbsm[i]) < 127.0F;
    }
  }
  return sums;
}

/// Recorded before there were profiles: the first two seconds of each scenario that was shipped then, with seed 3.
struct Before {
  const char* scenario;
  std::size_t detections;
  double range_m, azimuth_rad, range_rate_mps, rcs_dbsm;
};
constexpr std::array<Before, 11> kBefore = {
    {{"aligned_drive", 13219, 545212.9697, 368.261245, 696.0426, -11418.0},
     {"city_canyon", 19691, 777762.2715, 168.230323, 3565.3035, -65824.0},
     {"curve_with_rail", 9369, 416676.7436, 156.357339, -21610.9908, -11776.0},
     {"demo_drive", 13296, 548286.0258, 379.745547, -1141.5908, -11381.0},
     {"highway_multipath", 6095, 152644.5400, -14.858572, 2186.0928, -32392.0},
     {"junction", 15468, 589603.5633, -606.583794, 2057.1140, -51032.0},
     {"motorway_braking", 12003, 464312.5999, 179.217600, -18418.7957, -33534.0},
     {"parking_garage", 8106, 148668.0029, -149.278612, 1035.7946, -9501.0},
     {"straight_rail", 14082, 624572.8466, -23.225695, -7961.5839, -14145.0},
     {"truck_overtaking", 13557, 538435.8232, 195.088743, -5997.2455, -30268.0},
     {"tunnel", 14170, 584117.6082, -11.979449, -51120.6028, -45034.0}}};

TEST(IdealProfile, IsTodaysOutputOfTheScenariosThatAreOlder) {
  for (const Before& before : kBefore) {
    const Sums now = sums_of(scenario_with(before.scenario, "ideal"), 2.0);
    EXPECT_EQ(now.detections, before.detections) << before.scenario;
    EXPECT_NEAR(now.range_m, before.range_m, 1e-3) << before.scenario;
    EXPECT_NEAR(now.azimuth_rad, before.azimuth_rad, 1e-4) << before.scenario;
    EXPECT_NEAR(now.range_rate_mps, before.range_rate_mps, 1e-3) << before.scenario;
    EXPECT_EQ(now.rcs_dbsm, before.rcs_dbsm) << before.scenario;
  }
}

class ScenarioWithProfile : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(ScenarioWithProfile, RunsAndIsTheSameAgain) {
  const auto& [name, profile] = GetParam();
  const Scenario s = scenario_with(name, profile);
  constexpr double kPart_s = 1.5;
  const Sums once = sums_of(s, kPart_s), again = sums_of(s, kPart_s);
  EXPECT_GT(once.detections, 100u);
  EXPECT_TRUE(once.sound);
  EXPECT_EQ(once.detections, again.detections);
  EXPECT_EQ(once.range_m, again.range_m);
  EXPECT_EQ(once.rcs_dbsm, again.rcs_dbsm);
  if (profile == "ideal") {
    EXPECT_EQ(once.causes.size(), 1u) << "no statistical effect";
  } else {
    EXPECT_GT(once.causes.at(Cause::kFalseMover), 10u);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ScenarioWithProfile,
                         testing::Combine(testing::ValuesIn(scenario_names()),
                                          testing::ValuesIn(radar_profile_names())));

TEST(Profiles, AShorterDriveIsTheBeginningOfALongerOne) {
  const Scenario s = scenario_with("motorway_braking", "series_77ghz");
  const auto ranges = [&](double duration_s) {
    Drive drive(s, vehicle_of(s), 3, duration_s);
    std::vector<float> values;
    while (const Event* event = drive.next()) {
      if (event->t_s > 1.0) break;
      for (std::size_t i = 0; event->scan != nullptr && i < event->truth->size(); ++i) {
        values.push_back(event->scan->range_m[i]);
      }
    }
    return values;
  };
  EXPECT_EQ(ranges(1.0), ranges(20.0));
}

TEST(Profiles, OneRadarMayHaveAnother) {
  Scenario s = scenario("demo_drive");
  s.effects.profiles = {{2, radar_profile("series_77ghz")}};
  Drive drive(s, vehicle_of(s), 3, 1.0), ideal(scenario("demo_drive"), vehicle_of(s), 3, 1.0);
  std::size_t different = 0;
  while (const Event* event = drive.next()) {
    const Event* const before = ideal.next();
    ASSERT_NE(before, nullptr);
    if (event->scan == nullptr) continue;
    const bool same = event->scan->number_of_valid_detections == before->scan->number_of_valid_detections &&
                      event->scan->range_m[0] == before->scan->range_m[0];
    EXPECT_TRUE(same || event->scan->header.source_id == 2);
    different += same ? 0 : 1;
  }
  EXPECT_GT(different, 15u);
}

class WrittenDrive : public testing::Test {
 protected:
  static fs::path folder() { return fs::temp_directory_path() / ("boresight-profiles-" + std::to_string(::getpid())); }
  static void TearDownTestSuite() { fs::remove_all(folder()); }
  static DriveFiles write(const std::string& profile) {
    const Scenario s = scenario_with("city_canyon", profile);
    return write_drive(s, vehicle_of(s), 3, 2.0, folder() / profile, [](double) {});
  }
};

TEST_F(WrittenDrive, TheTruthTableNamesTheCauseLast) {
  std::ifstream table(write("series_77ghz").detections);
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "t_s,radar,scan,index,provenance,object,bounces,mirror,source,cause");
  std::map<std::string, std::set<std::string>> provenances;  // by cause
  while (std::getline(table, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 10u) << line;
    provenances[cells[9]].insert(cells[4]);
  }
  EXPECT_EQ(provenances.at("false_mover"), std::set<std::string>{"clutter"});
  EXPECT_EQ(provenances.at("azimuth_ambiguity"), std::set<std::string>{"clutter"});
  EXPECT_TRUE(provenances.at("doppler_ambiguity").contains("clutter"));
  EXPECT_EQ(provenances.at("micro_doppler"), std::set<std::string>{"moving"});
  EXPECT_TRUE(provenances.at("none").contains("stationary"));
}

TEST_F(WrittenDrive, LongListsEndLaterSoScansFinishOutOfOrder) {
  const auto order_of = [&](const std::string& profile) {
    std::vector<std::pair<std::int64_t, std::int64_t>> sent_measured;
    const auto reader = recording::open_recordings({write(profile).radars}, [](const std::string&) {});
    recording::Frame frame;
    while (reader->next(frame)) {
      std::string_view problem;
      if (ingest::ars548::check(frame.payload, problem) != ingest::DecodeResult::kComplete) continue;
      sent_measured.emplace_back(frame.stamp_ns, ingest::ars548::stamp_of(frame.payload).time_ns);
    }
    return sent_measured;
  };
  std::size_t late = 0;
  const auto cluster = order_of("can_cluster"), ideal = order_of("ideal");
  ASSERT_EQ(cluster.size(), ideal.size());
  for (std::size_t i = 1; i < cluster.size(); ++i) {
    EXPECT_GE(cluster[i].first, cluster[i - 1].first) << "the recording is in the order of transmission";
    late += cluster[i].second < cluster[i - 1].second ? 1 : 0;
  }
  EXPECT_GT(late, 3u);
  for (const auto& [sent, measured] : ideal) EXPECT_NEAR(static_cast<double>(sent - measured), 20e6, 1e4);
}

TEST_F(WrittenDrive, TheGatewayReadsValidityAndExistence) {
  const Scenario s = scenario_with("city_canyon", "can_cluster");
  std::size_t invalid = 0;
  Drive drive(s, vehicle_of(s), 3, 2.0);
  while (const Event* event = drive.next()) {
    for (std::size_t i = 0; event->scan != nullptr && i < event->truth->size(); ++i) {
      invalid += (event->scan->detection_flags[i] & detection_flag::kInvalid) != 0 ? 1 : 0;
    }
  }
  const auto reader = recording::open_recordings({write("can_cluster").radars}, [](const std::string&) {});
  recording::Frame frame;
  const auto scan = std::make_unique<RadarScan>();
  std::size_t read_invalid = 0, detections = 0;
  double existence = 0.0;
  while (reader->next(frame)) {
    std::string_view problem;
    if (ingest::ars548::check(frame.payload, problem) != ingest::DecodeResult::kComplete) continue;
    static_cast<void>(ingest::ars548::decode(frame.payload, *scan));
    for (std::size_t i = 0; i < scan->number_of_valid_detections; ++i, ++detections) {
      read_invalid += (scan->detection_flags[i] & detection_flag::kInvalid) != 0 ? 1 : 0;
      existence += static_cast<double>(scan->existence_probability[i]);
    }
  }
  EXPECT_EQ(read_invalid, invalid);
  EXPECT_GT(invalid, detections / 3);
  EXPECT_NEAR(existence / static_cast<double>(detections), 0.57, 0.1);
}

}  // namespace
}  // namespace boresight::simulator
