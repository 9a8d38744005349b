#include "services/simulator/alignment/spec.hpp"

#include <array>
#include <cmath>
#include <string>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator {

namespace {

/// Burza 2025, Table 1: (α, β, γ) of the radars in degrees.
constexpr std::array<std::array<double, 3>, 4> kTable1_deg{
    {{-1.0, 1.0, 2.0}, {2.0, -1.0, 1.0}, {1.0, 2.0, -1.0}, {-2.0, -2.0, -2.0}}};

void set_source(RadarConfig& radar) {
  radar.profile = RadarProfile::kArs548;
  radar.source = {};
  radar.source.link = LinkKind::kUdp;
  radar.source.address = "224.0.2.2";
  radar.source.port = 42102;
  radar.source.sender = "10.13.1." + std::to_string(112 + radar.id);
}

void add_radar(AlignmentSpec& spec, const RadarConfig& config) {
  const std::array<double, 3>& angles = kTable1_deg[spec.radars.size() % kTable1_deg.size()];
  AlignmentRadar radar;
  radar.config = config;
  set_source(radar.config);
  radar.truth = {angles[0] * kRadiansPerDegree, angles[1] * kRadiansPerDegree, angles[2] * kRadiansPerDegree};
  radar.states_stds = true;
  spec.radars.push_back(radar);
}

RadarConfig corner_radar(std::uint32_t id, const char* name, double x_m, double y_m, double yaw_deg) {
  RadarConfig radar;
  radar.id = id;
  radar.name = name;
  radar.mounting_pose.position_m = {x_m, y_m, 0.5};
  radar.mounting_pose.yaw_rad = yaw_deg * kRadiansPerDegree;
  // Detections are drawn 5° and 3° inside: ±65° and ±15° as in the prototype.
  radar.field_of_view = {-70.0 * kRadiansPerDegree, 70.0 * kRadiansPerDegree, -18.0 * kRadiansPerDegree,
                         18.0 * kRadiansPerDegree, 120.0};
  radar.noise = {0.15, 0.3 * kRadiansPerDegree, 0.6 * kRadiansPerDegree, 0.03};
  radar.cycle_time_s = 0.05;
  return radar;
}

}  // namespace

AlignmentSpec four_corner_radars() {
  AlignmentSpec spec;
  add_radar(spec, corner_radar(1, "front_left", 3.65, 0.75, 45.0));
  add_radar(spec, corner_radar(2, "front_right", 3.65, -0.75, -45.0));
  add_radar(spec, corner_radar(3, "rear_left", -0.85, 0.70, 135.0));
  add_radar(spec, corner_radar(4, "rear_right", -0.85, -0.70, -135.0));
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
    radar.config.noise.azimuth_std_rad = 0.15 * kRadiansPerDegree;
    radar.config.noise.elevation_std_rad = 0.3 * kRadiansPerDegree;
  }
  return spec;
}

AlignmentSpec radars_of(const VehicleConfig& vehicle) {
  AlignmentSpec spec;
  spec.speed_std_mps = vehicle.ego.speed_std_mps;
  spec.yaw_rate_std_radps = vehicle.ego.yaw_rate_std_radps;
  for (const RadarConfig& radar : vehicle.radars) add_radar(spec, radar);
  return spec;
}

void draw_truth(AlignmentSpec& spec) {
  Stream stream(spec.seed, "alignment truth");
  spec.speed_scale = stream.uniform(0.97, 1.03);
  for (AlignmentRadar& radar : spec.radars) {
    for (double* angle : {&radar.truth.yaw_rad, &radar.truth.pitch_rad, &radar.truth.roll_rad}) {
      *angle = stream.uniform(-3.0, 3.0) * kRadiansPerDegree;
    }
  }
}

const char* name_of(RoadKind road) {
  switch (road) {
    case RoadKind::kCity:
      return "city";
    case RoadKind::kMotorway:
      return "motorway";
    case RoadKind::kStraight:
      return "straight";
    case RoadKind::kSlow:
      return "slow";
    case RoadKind::kMixed:
      break;
  }
  return "mixed";
}

}  // namespace boresight::simulator
