// A street that stands still: rails, clutter and cars, as the two radars of `scene.hpp` see it from a vehicle that
// drives.
#pragma once

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "services/tracker/core/surroundings/surroundings.hpp"
#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {

/// Points that stand in the world; each is detected in a scan with a probability.
struct StandingPoint {
  Eigen::Vector2d place_m;
  double height_m = 0.7;
  double strength_db = -5.0;
  double probability = 0.4;
};

/// Drives on a circle (or straight) through standing points.
class StandingWorld {
 public:
  explicit StandingWorld(std::uint64_t seed) : random_(seed) {}

  std::vector<StandingPoint> points;
  double speed_mps = 15.0, yaw_rate_radps = 0.0;
  double range_std_m = 0.15, azimuth_std_rad = 0.005;
  double mirror = 1.0;  ///< −1: all is seen mirrored at the vehicle's x axis, with the same random numbers

  void add_rail(double lateral_m, double from_m, double to_m, double spacing_m = 2.0) {
    for (double x = from_m; x <= to_m; x += spacing_m) points.push_back({{x, lateral_m}});
  }
  void add_clutter(double per_m2, double from_m, double to_m, double inner_m, double outer_m) {
    std::uniform_real_distribution<double> along(from_m, to_m), aside(inner_m, outer_m);
    const double count = per_m2 * (to_m - from_m) * (outer_m - inner_m) * 2.0;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const double y = aside(random_);
      points.push_back({{along(random_), i % 2 == 0 ? y : -y}, 0.7, -15.0, 0.3});
    }
  }
  /// Of `count` detections a scan, anywhere on it.
  void add_car(const Eigen::Vector2d& rear_m, double count = 2.0, double height_m = 0.7) {
    for (int i = 0; i < 10; ++i) {
      points.push_back({rear_m + Eigen::Vector2d(0.15 * (i % 2), -0.8 + 0.16 * i), height_m, 5.0, count / 10.0});
    }
  }
  /// The next scan, of a radar whose mounting is that of Scene::begin().
  const ClassifiedScan& scan(double elapsed_s, std::uint32_t radar = 1) {
    const geometry::EgoStep step = geometry::ego_step(speed_mps, yaw_rate_radps, elapsed_s);
    const Eigen::Rotation2Dd heading(heading_rad_);
    position_m_ += heading * step.translation_m;
    heading_rad_ += yaw_rate_radps * elapsed_s;
    now_ns_ += static_cast<std::int64_t>(std::llround(1e9 * elapsed_s));
    scene_.begin(now_ns_, radar, speed_mps, mirror * yaw_rate_radps);
    scene_.scan->fields = scan_field::kElevation | scan_field::kRcs;
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    std::normal_distribution<double> normal;
    const Eigen::Rotation2Dd to_vehicle(-heading_rad_);
    for (const StandingPoint& p : points) {
      const Eigen::Vector2d at = to_vehicle * (p.place_m - position_m_);
      const Eigen::Vector2d sight = at - Eigen::Vector2d(3.6, 0.0);
      const double azimuth = std::atan2(sight.y(), sight.x()), in_view = azimuth - (radar == 1 ? 0.0 : 0.5 * M_PI);
      const double draw = chance(random_), range_noise = normal(random_), azimuth_noise = normal(random_);
      const double strength_noise = normal(random_);
      if (draw >= p.probability || sight.norm() > 70.0 || std::abs(in_view) > 1.0) continue;
      if (scene_.scan->number_of_valid_detections >= kMaxDetections) break;
      const double range = sight.norm() + range_std_m * range_noise, angle = azimuth + azimuth_std_rad * azimuth_noise;
      const Eigen::Vector2d seen(3.6 + range * std::cos(angle), mirror * range * std::sin(angle));
      const std::uint32_t i = scene_.scan->number_of_valid_detections;
      scene_.add(seen, Eigen::Vector2d::Zero(), Provenance::kStationary);
      scene_.scan->set_certain(i, Provenance::kStationary);
      scene_.scan->z_vehicle_m[i] = static_cast<float>(p.height_m);
      scene_.scan->rcs_dbsm[i] = static_cast<float>(p.strength_db + 5.0 * strength_noise);
      scene_.scan->range_std_m[i] = static_cast<float>(range_std_m);
      scene_.scan->azimuth_std_rad[i] = static_cast<float>(azimuth_std_rad);
    }
    return *scene_.scan;
  }
  /// A place of the world in the vehicle frame.
  [[nodiscard]] Eigen::Vector2d in_vehicle(const Eigen::Vector2d& place_m) const {
    const Eigen::Vector2d at = Eigen::Rotation2Dd(-heading_rad_) * (place_m - position_m_);
    return {at.x(), mirror * at.y()};
  }
  Scene& scene() { return scene_; }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }

 private:
  std::mt19937_64 random_;
  Scene scene_;
  Eigen::Vector2d position_m_{0.0, 0.0};
  double heading_rad_ = 0.0;
  std::int64_t now_ns_ = 1'000'000 * kMillisecond;
};

/// The surroundings of two_radars() with the shipped settings.
struct Watched {
  explicit Watched(const SurroundingsParameters& parameters = {})
      : surroundings(two_radars(), parameters, 0.3, 2.0), list(std::make_unique<TrackList>()) {
    std::memset(static_cast<void*>(list.get()), 0, sizeof(TrackList));
  }
  const TrackList& take(const ClassifiedScan& scan) {
    surroundings.step(scan, *list);
    surroundings.write(*list);
    return *list;
  }
  const TrackList& drive(StandingWorld& world, int scans, double elapsed_s = 0.025, std::uint32_t radar = 1) {
    for (int i = 0; i < scans; ++i) take(world.scan(elapsed_s, radar));
    return *list;
  }
  [[nodiscard]] const RoadEdge* edge(RoadSide side) const {
    for (std::size_t k = 0; k < list->number_of_road_edges; ++k) {
      if (list->road_edges[k].side == side) return &list->road_edges[k];
    }
    return nullptr;
  }

  Surroundings surroundings;
  std::unique_ptr<TrackList> list;
};

inline double edge_at(const RoadEdge& e, double x_m) {
  return static_cast<double>(e.coefficients[0]) + static_cast<double>(e.coefficients[1]) * x_m +
         0.5 * static_cast<double>(e.coefficients[2]) * x_m * x_m;
}

}  // namespace boresight::tracking
