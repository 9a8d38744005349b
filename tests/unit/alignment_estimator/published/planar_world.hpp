// Four corner radars in a world that follows the planar model, without noise: methods must find the exact values.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "services/alignment_estimator/core/published/published.hpp"
#include "services/alignment_estimator/core/published/published_method.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::alignment::published {

inline VehicleConfig four_corners() {
  VehicleConfig vehicle;
  const double x[] = {3.65, 3.65, -0.85, -0.85}, y[] = {0.75, -0.75, 0.7, -0.7}, yaw[] = {45.0, -45.0, 135.0, -135.0};
  for (std::uint32_t i = 0; i < 4; ++i) {
    RadarConfig radar;
    radar.id = i + 1;
    radar.mounting_pose = {{x[i], y[i], 0.5}, yaw[i] * kRadiansPerDegree, 0.0, 0.0};
    radar.cycle_time_s = 0.05;
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

/// Table 1 of Burza 2025.
inline std::vector<Eigen::Vector4d> table_1() {
  const double deg[4][3] = {{-1, 1, 2}, {2, -1, 1}, {1, 2, -1}, {-2, -2, -2}};
  std::vector<Eigen::Vector4d> truth;
  for (const auto& d : deg)
    truth.emplace_back(1.01, d[0] * kRadiansPerDegree, d[1] * kRadiansPerDegree, d[2] * kRadiansPerDegree);
  return truth;
}

class PlanarWorld {
 public:
  explicit PlanarWorld(unsigned seed = 1) : random_(seed) {}

  /// The scan of one radar at `time_s`, with the motion at that time.
  void look(std::size_t radar, double time_s) {
    std::uniform_real_distribution<double> azimuth(-1.1, 1.1), elevation(-0.15, 0.15), share(0.0, 1.0),
        own(-20.0, 20.0);
    std::normal_distribution<double> normal(0.0, 1.0);
    ego = {true, false, speed_mps + 2.0 * std::sin(0.3 * time_s), 0.0, turning_radps * std::sin(0.41 * time_s), 0.0};
    scan->time_ns = 1'000'000'000 + std::llround(time_s * 1e9);
    scan->count = detections;
    scan->has_elevation = measures_elevation;
    scan->ambiguity_mps = ambiguity_mps;
    const PlanarModel model(vehicle.radars[radar].mounting_pose, truth[radar], ego.speed_mps, ego.yaw_rate_radps);
    for (std::size_t i = 0; i < detections; ++i) {
      const double a = one_azimuth ? 0.2 : azimuth(random_);
      const double e = measures_elevation && !one_azimuth ? elevation(random_) : 0.0;
      double range_rate = model.value(a, e) + noise_mps * normal(random_);
      if (share(random_) < movers) range_rate += own(random_);
      if (ambiguity_mps > 0.0) range_rate = std::remainder(range_rate, ambiguity_mps);
      scan->azimuth_rad[i] = a;
      scan->elevation_rad[i] = e;
      scan->range_rate_mps[i] = range_rate;
      scan->azimuth_std_rad[i] = scan->elevation_std_rad[i] = scan->range_rate_std_mps[i] = 0.01;
    }
  }
  /// All radars in turn, `scans` times; `stagger_s` between two radars of a cycle.
  void drive(Method& method, int scans, double stagger_s = 0.0) {
    for (int i = 0; i < scans; ++i, time_s += 0.05) {
      for (std::size_t r = 0; r < vehicle.radars.size(); ++r) {
        look(r, time_s + stagger_s * static_cast<double>(r));
        method.process(r, *scan, ego);
      }
    }
  }

  VehicleConfig vehicle = four_corners();
  std::vector<Eigen::Vector4d> truth = table_1();
  std::size_t detections = 40;
  double speed_mps = 12.0, turning_radps = 0.3, noise_mps = 0.0, movers = 0.0, ambiguity_mps = 0.0;
  bool measures_elevation = true, one_azimuth = false;
  double time_s = 0.0;
  std::unique_ptr<ScanDetections> scan = std::make_unique<ScanDetections>();
  EgoSample ego;

 private:
  std::mt19937 random_;
};

inline Eigen::Vector4d parameters(const Method& method, std::size_t radar) {
  return dynamic_cast<const PublishedMethod&>(method).parameters(radar);
}

}  // namespace boresight::alignment::published
