// Three minutes of a drive by another simulator, with four radars misaligned in all three angles. The one-dimensional
// reference method must find yaw and k_v.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/common/geometry/angles.hpp"
#include "tests/golden/support/decoded.hpp"

namespace boresight::golden {
namespace {

namespace fs = std::filesystem;
const fs::path kAlignmentDrive = shared_data() / "alignment_drive";

struct Truth {
  double speed_scale = 0.0;
  std::map<std::uint32_t, double> yaw_rad;
  VehicleConfig vehicle;
};

Truth read_truth(const fs::path& file) {
  Truth truth;
  std::ifstream input(file);
  for (std::string line; std::getline(input, line);) {
    std::istringstream words(line);
    std::string word, unused;
    words >> word;
    if (word == "k_v") words >> truth.speed_scale;
    if (word != "radar") continue;
    RadarConfig radar;
    double mount_deg = 0.0, yaw_deg = 0.0;
    words >> radar.id >> unused >> mount_deg >> unused >> radar.mounting_pose.position_m[0] >> unused >>
        radar.mounting_pose.position_m[1] >> unused >> yaw_deg;
    radar.mounting_pose.yaw_rad = mount_deg * kRadiansPerDegree;
    radar.noise = {.range_std_m = 0.15,
                   .azimuth_std_rad = 0.3 * kRadiansPerDegree,
                   .elevation_std_rad = 0.6 * kRadiansPerDegree,
                   .range_rate_std_mps = 0.05};
    truth.yaw_rad[radar.id] = yaw_deg * kRadiansPerDegree;
    truth.vehicle.radars.push_back(radar);
  }
  return truth;
}

/// The lines of a compressed file; empty without a program to decompress it.
std::vector<std::string> unpack(const fs::path& file) {
  std::vector<std::string> lines;
  FILE* const pipe = popen(("xz -dc '" + file.string() + "' 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return lines;
  std::array<char, 256> buffer;
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) lines.emplace_back(buffer.data());
  pclose(pipe);
  return lines;
}

TEST(AlignmentDrive, YawAndSpeedScaleAreFoundDespitePitchAndRoll) {
  REQUIRE_RECORDING(kAlignmentDrive);
  const Truth truth = read_truth(kAlignmentDrive / "truth_1.txt");
  ASSERT_EQ(truth.vehicle.radars.size(), 4u);
  const auto lines = unpack(kAlignmentDrive / "drive_1.csv.xz");
  if (lines.empty()) GTEST_SKIP() << "skipped: no xz";
  std::map<long, EgoMotion> egos;  // by time in ms
  std::ifstream ego_file(kAlignmentDrive / "ego_1.csv");
  for (std::string line; std::getline(ego_file, line);) {
    double t = 0.0, v = 0.0, w = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &t, &v, &w) != 3) continue;
    EgoMotion ego{};
    ego.header.measurement_time_ns = 1'000'000'000 + std::lround(t * 1e9);
    ego.fields = ego_field::kSpeed | ego_field::kYawRate;
    ego.speed_mps = static_cast<float>(v);
    ego.speed_std_mps = 0.05F;
    ego.yaw_rate_radps = static_cast<float>(w);
    ego.yaw_rate_std_radps = 0.003F;
    egos[std::lround(t * 1e3)] = ego;
  }
  alignment::Estimator estimator(truth.vehicle, alignment::Config{});
  auto scan = std::make_unique<RadarScan>();
  long scan_ms = -1;
  std::uint32_t scan_radar = 0;
  std::uint32_t count = 0;
  const auto finish = [&] {
    if (scan_ms < 0) return;
    scan->header.source_id = scan_radar;
    scan->header.measurement_time_ns = 1'000'000'000 + scan_ms * 1'000'000;
    scan->number_of_valid_detections = count;
    scan->fields = scan_field::kElevation;
    static_cast<void>(estimator.add_scan(*scan));
  };
  long ego_ms = -1;
  for (const std::string& line : lines) {
    double t = 0.0, range = 0.0, azimuth = 0.0, elevation = 0.0, range_rate = 0.0;
    unsigned radar = 0;
    if (std::sscanf(line.c_str(), "%lf,%u,%lf,%lf,%lf,%lf", &t, &radar, &range, &azimuth, &elevation, &range_rate) !=
        6) {
      continue;
    }
    const long ms = std::lround(t * 1e3);
    if (ms != scan_ms || radar != scan_radar) {
      finish();
      if (ms != ego_ms) {
        if (const auto ego = egos.find(ms); ego != egos.end()) estimator.add_ego_motion(ego->second);
        ego_ms = ms;
      }
      scan_ms = ms;
      scan_radar = radar;
      count = 0;
    }
    if (count == kMaxDetections) continue;
    scan->range_m[count] = static_cast<float>(range);
    scan->azimuth_rad[count] = static_cast<float>(azimuth);
    scan->elevation_rad[count] = static_cast<float>(elevation);
    scan->range_rate_mps[count] = static_cast<float>(range_rate);
    scan->detection_flags[count++] = 0;
  }
  finish();
  for (const auto& [id, yaw_rad] : truth.yaw_rad) {
    AlignmentEstimate found{};
    ASSERT_TRUE(estimator.write(id, found));
    std::printf("radar %u: k_v %.5f (true %.5f), yaw %+.3f° ± %.3f° (true %+.3f°)\n", id, found.speed_scale,
                truth.speed_scale, found.alignment_yaw_rad / kRadiansPerDegree,
                std::sqrt(found.covariance[5]) / kRadiansPerDegree, yaw_rad / kRadiansPerDegree);
    EXPECT_EQ(found.state, AlignmentState::kConverged) << id;
    EXPECT_NEAR(found.speed_scale, truth.speed_scale, 5e-4) << id;
    EXPECT_NEAR(found.alignment_yaw_rad, yaw_rad, 0.05 * kRadiansPerDegree) << id;
  }
}

}  // namespace
}  // namespace boresight::golden
