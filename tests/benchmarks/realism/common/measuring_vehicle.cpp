#include "tests/benchmarks/realism/common/measuring_vehicle.hpp"

#include <cmath>
#include <span>

#include "services/simulator/scenario/read_profile.hpp"

namespace boresight::bench::realism {

namespace {

constexpr double kDegree = M_PI / 180.0;

struct Mount {
  const char* name;
  double x_m, y_m, yaw_deg;
};
constexpr Mount kRadarScenesMounts[] = {{"forward_left", 3.65, 0.6, 25.0},
                                        {"forward_right", 3.65, -0.6, -25.0},
                                        {"side_left", 3.65, 0.8, 85.0},
                                        {"side_right", 3.65, -0.8, -85.0}};
constexpr Mount kNuScenesMounts[] = {{"front", 3.65, 0.0, 0.0},
                                     {"side_left", 3.3, 0.9, 90.0},
                                     {"side_right", 3.3, -0.9, -90.0},
                                     {"rear_left", -0.9, 0.6, 170.0},
                                     {"rear_right", -0.9, -0.6, -170.0}};
constexpr double kRadarScenesCycle_s = 0.075, kNuScenesCycle_s = 0.077;
constexpr double kHalfView_deg = 70.0, kRange_m = 100.0, kHeight_m = 0.5;

}  // namespace

Source source_of(const std::string& profile) {
  if (profile == "ideal") return Source::kNone;
  return profile == "can_cluster" ? Source::kNuScenes : Source::kRadarScenes;
}

simulator::Scenario with_profile(simulator::Scenario scenario, const std::string& profile) {
  simulator::use_profile(scenario, profile);
  scenario.effects.profile.strength.radar_offset_db = 0.0;
  return scenario;
}

VehicleConfig measuring_vehicle(const VehicleConfig& demo, Source source) {
  const bool five = source == Source::kNuScenes;
  const std::span<const Mount> mounts =
      five ? std::span<const Mount>(kNuScenesMounts) : std::span<const Mount>(kRadarScenesMounts);
  VehicleConfig vehicle = demo;
  RadarConfig radar = demo.radars.front();
  vehicle.radars.clear();
  radar.id = 0;
  radar.cycle_time_s = five ? kNuScenesCycle_s : kRadarScenesCycle_s;
  radar.field_of_view.azimuth_min_rad = -kHalfView_deg * kDegree;
  radar.field_of_view.azimuth_max_rad = kHalfView_deg * kDegree;
  radar.field_of_view.range_max_m = kRange_m;
  for (const Mount& mount : mounts) {
    ++radar.id;
    radar.name = mount.name;
    radar.mounting_pose.position_m = {mount.x_m, mount.y_m, kHeight_m};
    radar.mounting_pose.yaw_rad = mount.yaw_deg * kDegree;
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

}  // namespace boresight::bench::realism
