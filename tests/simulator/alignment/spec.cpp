#include "tests/simulator/alignment/spec.hpp"

#include <cmath>
#include <string>

namespace boresight::simulator {

namespace {

constexpr double kDegree = M_PI / 180.0;

RadarConfig corner_radar(std::uint32_t id, const char* name, double x_m, double y_m, double yaw_deg) {
  RadarConfig radar;
  radar.id = id;
  radar.name = name;
  radar.source.link = LinkKind::kUdp;
  radar.source.address = "224.0.2.2";
  radar.source.port = 42102;
  radar.source.sender = "10.13.1." + std::to_string(112 + id);
  radar.mounting_pose.position_m = {x_m, y_m, 0.5};
  radar.mounting_pose.yaw_rad = yaw_deg * kDegree;
  // Detections are drawn 5° and 3° inside: ±65° and ±15° as in the prototype.
  radar.field_of_view = {-70.0 * kDegree, 70.0 * kDegree, -18.0 * kDegree, 18.0 * kDegree, 120.0};
  radar.noise = {0.15, 0.3 * kDegree, 0.6 * kDegree, 0.03};
  radar.cycle_time_s = 0.05;
  return radar;
}

}  // namespace

AlignmentSpec four_corner_radars() {
  AlignmentSpec spec;
  const auto add = [&spec](const RadarConfig& config, double yaw_deg, double pitch_deg, double roll_deg) {
    AlignmentRadar radar;
    radar.config = config;
    radar.truth = {yaw_deg * kDegree, pitch_deg * kDegree, roll_deg * kDegree};
    radar.states_stds = true;
    spec.radars.push_back(radar);
  };
  add(corner_radar(1, "front_left", 3.65, 0.75, 45.0), -1.0, 1.0, 2.0);
  add(corner_radar(2, "front_right", 3.65, -0.75, -45.0), 2.0, -1.0, 1.0);
  add(corner_radar(3, "rear_left", -0.85, 0.70, 135.0), 1.0, 2.0, -1.0);
  add(corner_radar(4, "rear_right", -0.85, -0.70, -135.0), -2.0, -2.0, -2.0);
  return spec;
}

AlignmentSpec published_setup() {
  AlignmentSpec spec = four_corner_radars();
  spec.road = RoadKind::kSlow;
  spec.model = MountingModel::kPlanar;
  spec.outlier_share = 0.0;
  spec.azimuth_std_edge = 1.0;
  spec.speed_std_mps = 0.0;
  spec.yaw_rate_std_radps = 0.0;
  for (AlignmentRadar& radar : spec.radars) {
    radar.mean_detections = 64.0;
    radar.config.noise.range_rate_std_mps = 0.022;
    radar.config.noise.azimuth_std_rad = 0.15 * kDegree;
    radar.config.noise.elevation_std_rad = 0.3 * kDegree;
  }
  return spec;
}

}  // namespace boresight::simulator
