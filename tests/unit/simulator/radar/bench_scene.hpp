// A radar at the world's origin with targets around it, without random effects unless a test enables them.
#pragma once

#include <memory>
#include <vector>

#include "services/simulator/radar/radar_sensor.hpp"

namespace boresight::simulator {

inline constexpr double kHeight_m = 0.6;

/// The sensor is in the origin of the vehicle, which drives along x with 20 m/s.
struct Bench {
  RadarConfig config;
  RadarEffects effects;
  radar::EgoBody ego_body{-5.0, 0.0, 0.9, 0.15, 1.5};
  Scene scene;
  std::uint64_t seed = 7;

  Bench() {
    config.id = 1;
    config.mounting_pose.position_m = {0.0, 0.0, kHeight_m};
    config.field_of_view = {-1.3, 1.3, -0.5, 0.5, 200.0};
    effects.noise = false;
    effects.clutter_per_scan = 0.0;
    effects.multipath.ground_bounce = false;
    effects.multipath.extra_loss_db = 0.0;
    effects.resolution = {0.0, 0.0, 0.0};
    effects.sensitivity.threshold_db = -160.0;  // everything is detected
    effects.sensitivity.max_probability = 1.0;
    effects.sensitivity.max_detections = 1024;
    scene.ego = {{0.0, 0.0}, 0.0, 20.0, 0.0, 0.0};
  }

  /// A body with one reflection centre in its middle, which reflects in all directions.
  Body& add_body(std::uint32_t id, Eigen::Vector3d centre, Eigen::Vector3d velocity, double rcs_dbsm = 10.0) {
    Body body{};
    body.id = id;
    body.kind = BodyKind::kCar;
    body.position_m = centre.head<2>();
    body.velocity_mps = velocity.head<2>();
    body.length_m = 4.0;
    body.width_m = 1.8;
    body.height_m = 1.5;
    body.clearance_m = 0.2;
    body.first_centre = static_cast<std::uint32_t>(scene.centres.size());
    body.number_of_centres = 1;
    scene.centres.push_back({centre, velocity, Eigen::Vector3d::Zero(), rcs_dbsm});
    scene.bodies.push_back(body);
    return scene.bodies.back();
  }
  MirrorSurface& add_rail(Eigen::Vector2d from, Eigen::Vector2d to, double loss_db = 3.0) {
    scene.surfaces.push_back({from, to, 0.3, 0.9, loss_db, {0.0, 0.0}, 0, true});
    return scene.surfaces.back();
  }
};

struct Measured {
  std::unique_ptr<RadarScan> scan = std::make_unique<RadarScan>();
  std::vector<DetectionTruth> truth;

  [[nodiscard]] std::size_t count() const { return scan->number_of_valid_detections; }
  /// Indices of the detections with this provenance and number of mirror reflections.
  [[nodiscard]] std::vector<std::size_t> of(Provenance provenance, unsigned bounces) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth[i].provenance == provenance && truth[i].bounces == bounces) found.push_back(i);
    }
    return found;
  }
  [[nodiscard]] std::size_t of(Provenance provenance) const {
    std::size_t n = 0;
    for (const DetectionTruth& t : truth) n += t.provenance == provenance ? 1 : 0;
    return n;
  }
};

[[nodiscard]] inline Measured measure(const Bench& bench, std::uint32_t cycle = 0) {
  RadarSensor sensor(bench.config, bench.effects, bench.ego_body, bench.seed);
  Measured m;
  sensor.measure(bench.scene, cycle, *m.scan, m.truth);
  return m;
}

}  // namespace boresight::simulator
