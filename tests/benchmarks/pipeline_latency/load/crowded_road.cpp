#include "tests/benchmarks/pipeline_latency/load/crowded_road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "services/common/geometry/frames.hpp"

namespace boresight::bench {

namespace {

constexpr std::uint64_t kSeed = 11;
constexpr double kPeriod_m = 224.0;  // of the road: a place leaves and enters beyond the range of every radar
constexpr double kCarLength_m = 4.5, kCarWidth_m = 1.8;
constexpr double kRail_m = 10.0, kPostSpacing_m = 2.0;
constexpr std::size_t kScatterers = 900;  // beside the road: each radar has more in view than kDetections
constexpr std::uint32_t kLeastDetections = 100;
constexpr double kScatter_m = 45.0;
constexpr double kLeastRange_m = 2.0;
constexpr double kSlowestFalse_mps = 2.0, kFastestFalse_mps = 20.0;
constexpr float kRcs_dbsm = 5.0F;

struct Lane {
  double lateral_m, speed_mps, first_m, spacing_m;
};
/// The lane of the own vehicle first, with a gap for it. The spacings divide kPeriod_m.
constexpr std::array<Lane, 4> kLanes = {
    {{0.0, 15.0, 16.0, 32.0}, {3.5, 19.0, 3.0, 28.0}, {-3.5, 11.0, 12.0, 28.0}, {7.0, -16.0, 7.0, 28.0}}};

/// A radar's view of a point in the plane, without noise.
struct Sight {
  double range_m, azimuth_rad;
  Eigen::Vector2d direction;  ///< in vehicle axes
};

Eigen::Vector2d position_of(const RadarConfig& radar) {
  return {radar.mounting_pose.position_m[0], radar.mounting_pose.position_m[1]};
}

std::optional<Sight> sight_of(const RadarConfig& radar, const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d line_m = point_m - position_of(radar);
  const double range_m = line_m.norm();
  const double azimuth_rad = geometry::wrap_angle(std::atan2(line_m.y(), line_m.x()) - radar.mounting_pose.yaw_rad);
  const FieldOfView& view = radar.field_of_view;
  const bool in_view = range_m > kLeastRange_m && range_m < view.range_max_m && azimuth_rad > view.azimuth_min_rad &&
                       azimuth_rad < view.azimuth_max_rad;
  if (!in_view) return std::nullopt;
  return Sight{range_m, azimuth_rad, line_m / range_m};
}

void append(const RadarConfig& radar, const Sight& sight, double range_rate_mps, simulator::Stream& random,
            RadarScan& scan) {
  const std::uint32_t i = scan.number_of_valid_detections++;
  const SensorNoise& noise = radar.noise;
  scan.range_m[i] = static_cast<float>(sight.range_m + noise.range_std_m * random.gaussian());
  scan.azimuth_rad[i] = static_cast<float>(sight.azimuth_rad + noise.azimuth_std_rad * random.gaussian());
  scan.elevation_rad[i] = 0.0F;
  scan.range_rate_mps[i] = static_cast<float>(range_rate_mps + noise.range_rate_std_mps * random.gaussian());
  scan.rcs_dbsm[i] = kRcs_dbsm;
  scan.range_std_m[i] = static_cast<float>(noise.range_std_m);
  scan.azimuth_std_rad[i] = static_cast<float>(noise.azimuth_std_rad);
  scan.elevation_std_rad[i] = static_cast<float>(noise.elevation_std_rad);
  scan.range_rate_std_mps[i] = static_cast<float>(noise.range_rate_std_mps);
  scan.existence_probability[i] = 0.9F;
  scan.detection_flags[i] = 0;
}

/// Points on the sides of the car that face the radar, in its view; fewer than wanted if the car is hardly in view.
std::vector<Sight> sights_of_body(const RadarConfig& radar, const Eigen::Vector2d& centre_m,
                                  simulator::Stream& random) {
  constexpr int kTries = 64;
  const double end_share = kCarWidth_m / (kCarWidth_m + kCarLength_m);
  std::vector<Sight> sights;
  for (int i = 0; i < kTries && sights.size() < kDetectionsOfVehicle; ++i) {
    const double side = random.uniform() < 0.5 ? -0.5 : 0.5, along_side = random.uniform(-0.5, 0.5);
    const bool is_end = random.uniform() < end_share;
    const Eigen::Vector2d from_centre_m = is_end ? Eigen::Vector2d(side * kCarLength_m, along_side * kCarWidth_m)
                                                 : Eigen::Vector2d(along_side * kCarLength_m, side * kCarWidth_m);
    const Eigen::Vector2d to_radar_m = position_of(radar) - centre_m - from_centre_m;
    if (side * (is_end ? to_radar_m.x() : to_radar_m.y()) <= 0.0) continue;
    if (const auto sight = sight_of(radar, centre_m + from_centre_m)) sights.push_back(*sight);
  }
  return sights;
}

}  // namespace

CrowdedRoad::CrowdedRoad(double ego_speed_mps, std::uint32_t detections)
    : ego_speed_mps_(ego_speed_mps), stationary_detections_(detections - kMovingDetections - kFalseDetections) {
  if (detections < kLeastDetections) throw std::logic_error("too few detections for this road");
  for (const Lane& lane : kLanes) {
    for (double x_m = lane.first_m; x_m < lane.first_m + kPeriod_m; x_m += lane.spacing_m) {
      vehicles_.push_back({{x_m, lane.lateral_m}, lane.speed_mps});
    }
  }
  for (double x_m = 0.0; x_m < kPeriod_m; x_m += kPostSpacing_m) {
    reflectors_m_.emplace_back(x_m, kRail_m);
    reflectors_m_.emplace_back(x_m, -kRail_m);
  }
  simulator::Stream random(kSeed, "scatterers");
  const std::size_t scatterers = kScatterers * stationary_detections_ / kStationaryDetections;
  for (std::size_t i = 0; i < scatterers; ++i) {
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    reflectors_m_.emplace_back(random.uniform(0.0, kPeriod_m), side * random.uniform(kRail_m, kScatter_m));
  }
}

double CrowdedRoad::along_m(double start_m, double speed_mps, double t_s) const {
  return std::remainder(start_m + (speed_mps - ego_speed_mps_) * t_s, kPeriod_m);
}

void CrowdedRoad::measure(const RadarConfig& radar, double t_s, std::uint32_t cycle, RadarScan& scan) const {
  simulator::Stream random(kSeed, "scan", radar.id, cycle);
  scan.cycle_counter = cycle;
  scan.number_of_valid_detections = 0;
  add_moving(radar, t_s, random, scan);
  add_false(radar, random, scan);
  add_stationary(radar, t_s, random, scan);
}

/// The nearest vehicles in view; the range rate is that of the vehicle's motion at each of its points.
void CrowdedRoad::add_moving(const RadarConfig& radar, double t_s, simulator::Stream& random, RadarScan& scan) const {
  struct Seen {
    double range_m, speed_mps;
    Eigen::Vector2d centre_m;
  };
  std::vector<Seen> seen;
  for (const Vehicle& vehicle : vehicles_) {
    const Eigen::Vector2d centre_m(along_m(vehicle.start_m.x(), vehicle.speed_mps, t_s), vehicle.start_m.y());
    if (const auto sight = sight_of(radar, centre_m)) seen.push_back({sight->range_m, vehicle.speed_mps, centre_m});
  }
  std::sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) { return a.range_m < b.range_m; });
  for (const Seen& vehicle : seen) {
    if (scan.number_of_valid_detections == kMovingDetections) break;
    const std::vector<Sight> sights = sights_of_body(radar, vehicle.centre_m, random);
    if (sights.size() < kDetectionsOfVehicle) continue;
    for (const Sight& sight : sights) {
      append(radar, sight, sight.direction.x() * (vehicle.speed_mps - ego_speed_mps_), random, scan);
    }
  }
  if (scan.number_of_valid_detections != kMovingDetections) throw std::logic_error("too few vehicles in view");
}

void CrowdedRoad::add_false(const RadarConfig& radar, simulator::Stream& random, RadarScan& scan) const {
  const FieldOfView& view = radar.field_of_view;
  for (std::uint32_t i = 0; i < kFalseDetections; ++i) {
    const double range_m = random.uniform(kLeastRange_m, view.range_max_m);
    const double azimuth_rad = random.uniform(view.azimuth_min_rad, view.azimuth_max_rad);
    const double azimuth_vehicle_rad = azimuth_rad + radar.mounting_pose.yaw_rad;
    const Sight sight{range_m, azimuth_rad, {std::cos(azimuth_vehicle_rad), std::sin(azimuth_vehicle_rad)}};
    const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double over_ground_mps = sign * random.uniform(kSlowestFalse_mps, kFastestFalse_mps);
    append(radar, sight, over_ground_mps - ego_speed_mps_ * sight.direction.x(), random, scan);
  }
}

/// A random choice of the reflectors in view.
void CrowdedRoad::add_stationary(const RadarConfig& radar, double t_s, simulator::Stream& random,
                                 RadarScan& scan) const {
  std::vector<Sight> seen;
  for (const Eigen::Vector2d& reflector_m : reflectors_m_) {
    const auto sight = sight_of(radar, {along_m(reflector_m.x(), 0.0, t_s), reflector_m.y()});
    if (sight) seen.push_back(*sight);
  }
  if (seen.size() < stationary_detections_) throw std::logic_error("too few reflectors in view");
  for (std::size_t i = 0; i < stationary_detections_; ++i) {
    std::swap(seen[i], seen[i + random.next() % (seen.size() - i)]);
    append(radar, seen[i], -ego_speed_mps_ * seen[i].direction.x(), random, scan);
  }
}

}  // namespace boresight::bench
