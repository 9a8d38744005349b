// An object that drives straight on, its detections drawn from the reflection model, and a tracker of this one object:
// association is known, the box comes from the BoxEstimator.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "services/common/extended_object/detection_count.hpp"
#include "services/tracker/core/model/box_estimator.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::support {

using extended_object::RoadUserClass;

inline const extended_object::ObjectClassTable& class_table() {
  static const extended_object::ObjectClassTable table = extended_object::object_class_table_defaults();
  return table;
}
inline constexpr std::size_t index_of(RoadUserClass c) {
  return static_cast<std::size_t>(c);
}

struct SimulatedObject {
  RoadUserClass object_class = RoadUserClass::kCar;
  double length_m = 4.6, width_m = 1.85, depth_m = 0.0;  // depth: its own, beside that of its class
  Eigen::Vector2d centre_m{0.0, 0.0};
  double heading_rad = 0.0, speed_mps = 10.0;

  [[nodiscard]] Eigen::Vector2d velocity_mps() const {
    return speed_mps * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  }
};

/// Length and own depth as the table says they are distributed.
inline SimulatedObject drawn_object(Random& random, RoadUserClass c) {
  const auto& model = extended_object::model_of(class_table(), c);
  SimulatedObject o;
  o.object_class = c;
  do {
    o.length_m = model.size.length_mean_m + model.size.length_std_m * normal(random);
  } while (o.length_m < 0.4 * model.size.length_mean_m);
  o.width_m = model.size.width_mean_m + model.size.width_std_m * normal(random);
  o.depth_m = model.places.lasting_std_m * normal(random);
  o.speed_mps = model.motion.typical_speed_mps;
  return o;
}

struct SimulatedRadar {
  Viewpoint viewpoint;
  double range_std_m = 0.15, azimuth_std_rad = 0.005, range_rate_std_mps = 0.05;
};

inline Symmetric2<double> noise_of(const SimulatedRadar& radar, const Eigen::Vector2d& place_m) {
  const Eigen::Vector2d way = place_m - eigen(radar.viewpoint.sensor_m);
  const double across_std = radar.azimuth_std_rad * way.norm();
  const Eigen::Matrix2d turn = rotation(std::atan2(way.y(), way.x()));
  return symmetric_of(turn *
                      Eigen::Vector2d(radar.range_std_m * radar.range_std_m, across_std * across_std).asDiagonal() *
                      turn.transpose());
}

/// Draws the scans of one radar. Places of reflections are held from scan to scan as the model says.
class Reflections {
 public:
  [[nodiscard]] Detections draw(Random& random, const SimulatedObject& o, const SimulatedRadar& radar) {
    const auto& model = extended_object::model_of(class_table(), o.object_class);
    const Eigen::Matrix2d to_local = rotation(o.heading_rad);
    const Eigen::Vector2d sensor_m = eigen(radar.viewpoint.sensor_m);
    const Eigen::Vector2d sensor_box = to_local.transpose() * (sensor_m - o.centre_m);
    const auto mixture = extended_object::reflection_mixture(model.places, o.length_m, o.width_m, sensor_box);
    const double expected =
        extended_object::expected_detections(model.count, sensor_box.norm(), sensor_box.normalized());
    const double rate =
        std::gamma_distribution<double>(model.count.dispersion_shape, expected / model.count.dispersion_shape)(random);
    const auto n = static_cast<std::size_t>(std::poisson_distribution<int>(rate)(random));
    for (Spot& spot : spots_) {
      if (uniform(random, 0.0, 1.0) < model.places.scan_correlation) continue;
      spot = {uniform(random, 0.0, 1.0), normal(random), normal(random)};
    }
    Detections z;
    for (std::size_t i = 0; i < n; ++i) {
      const Spot fresh{uniform(random, 0.0, 1.0), normal(random), normal(random)};
      const Spot& spot = i < spots_.size() ? spots_[i] : fresh;
      std::size_t k = 0;
      for (double left = spot.part - mixture[0].weight; left > 0.0 && k + 1 < mixture.size();) {
        left -= mixture[++k].weight;
      }
      const Eigen::Vector2d at_box = mixture[k].mean_m +
                                     mixture[k].variance_m2.cwiseSqrt().cwiseProduct(Eigen::Vector2d(spot.x, spot.y)) +
                                     o.depth_m * sensor_box.normalized();
      const Eigen::Vector2d way = o.centre_m + to_local * at_box - sensor_m;
      const double azimuth_rad = std::atan2(way.y(), way.x());
      const double across_m = radar.azimuth_std_rad * way.norm() * normal(random);
      const double along_m = radar.range_std_m * normal(random), off_mps = radar.range_rate_std_mps * normal(random);
      if (std::abs(std::remainder(azimuth_rad - radar.viewpoint.facing_rad, 2.0 * std::numbers::pi)) >
          radar.viewpoint.half_view_rad) {
        continue;
      }
      Measurement<double> m;
      m.sight = vector_of(way.normalized());
      m.position_m = vector_of(sensor_m + way + rotation(azimuth_rad) * Eigen::Vector2d(along_m, across_m));
      m.range_rate_mps = way.normalized().dot(o.velocity_mps()) + off_mps;
      z.push_back(m);
    }
    return z;
  }

 private:
  struct Spot {
    double part = 0.5, x = 0.0, y = 0.0;
  };
  std::array<Spot, 24> spots_{};
};

/// Readings of an object as RadarModel makes them: classes of about a car's size by their moments, a truck twice.
inline void set_readings(const ClassViews& views, double heading_rad, View<double>& v) {
  const Eigen::Matrix2d r = rotation(heading_rad);
  const auto turned = [&r](const Eigen::Matrix2d& m) { return Eigen::Matrix2d(r * m * r.transpose()); };
  constexpr auto kTruck = index_of(RoadUserClass::kTruck);
  double weight = 0.0;
  Eigen::Vector2d mean(0.0, 0.0);
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < kTruck; ++k) {
    weight += views[k].probability;
    mean += views[k].probability * views[k].offset_m;
  }
  const double sum = weight + views[kTruck].probability;
  if (sum <= 0.0) return;
  v.number_of_readings = 0;
  if (weight > 0.01) {
    mean /= weight;
    for (std::size_t k = 0; k < kTruck; ++k) {
      const Eigen::Vector2d off = views[k].offset_m - mean;
      covariance += views[k].probability / weight * (views[k].offset_covariance_m2 + off * off.transpose());
    }
    v.readings[v.number_of_readings++] = {
        weight / sum, vector_of(r * mean), symmetric_of(turned(covariance)), false, {}};
  }
  const ClassView& truck = views[kTruck];
  if (truck.probability > 0.01) {
    const double half = 0.5 * truck.probability / sum;
    const Vector2<double> offset = vector_of(r * truck.offset_m);
    const Symmetric2<double> own = symmetric_of(turned(truck.offset_covariance_m2)),
                             scatter = symmetric_of(turned(truck.reflections.scatter_m2));
    v.readings[v.number_of_readings++] = {half, offset, own, true, scatter};
    v.readings[v.number_of_readings++] = {half, offset, own + scatter, false, {}};
  }
}

/// One object and the radars that detect it in turn.
class OneObjectTrack {
 public:
  OneObjectTrack(const SimulatedObject& object, std::uint64_t seed, const BoxParameters& parameters = {})
      : truth(object), estimator(class_table(), parameters), memory(estimator.begin()), random_(seed) {
    motion_ = {0.3, 1.0, 1.0, 2.0, 8.0};
    // A birth as of the radar model: its first detections place it, and nothing is known of its velocity.
    component.position_covariance = {900.0, 0.0, 900.0};
    component.velocity_covariance = {100.0, 0.0, 100.0};
    component.rate_shape = 2.0;
    component.rate_inverse_scale = 2.0 / 1.5;
    component.extent_dof = 9.0;
    component.extent_scale = {6.75, 0.0, 6.75};
  }

  void scan(const SimulatedRadar& radar, Reflections& reflections, double elapsed_s) {
    truth.centre_m += elapsed_s * truth.velocity_mps();
    const Detections z = reflections.draw(random_, truth, radar);
    sensor_m = radar.viewpoint.sensor_m;
    if (!is_born_) {
      if (z.empty()) return;
      is_born_ = true;
      component.position_m = cell_of(z).mean();
    } else {
      predict(component, motion_, elapsed_s);
    }
    const ClassViews views =
        estimator.view(memory, component.position_m, std::sqrt(squared_norm(component.velocity_mps)), radar.viewpoint);
    View<double> v;
    v.detection_probability = 0.95;
    v.noise_m2 = noise_of(radar, eigen(component.position_m));
    v.range_rate_variance = radar.range_rate_std_mps * radar.range_rate_std_mps + 0.04;
    v.held = 5.0;
    set_readings(views, memory.heading_rad, v);
    BoxObservation o;
    o.elapsed_s = elapsed_s;
    o.road = {road_rad, RoadParameters{}.parallel_share, RoadParameters{}.parallel_share};
    o.range_m = (eigen(component.position_m) - eigen(sensor_m)).norm();
    o.noise_m2 = v.noise_m2;
    o.predicted_m = component.position_m;
    o.predicted_covariance_m2 = component.position_covariance;
    if (!z.empty()) {
      const Cell<double> cell = cell_of(z);
      o.detections = cell.n;
      o.mean_m = cell.mean();
      o.scatter = cell.scatter();
      component = Prediction<double>(component, v).updated(component, cell);
    }
    estimator.update(memory, component, o, views);
  }

  [[nodiscard]] Box box() const { return estimator.box(memory, component, sensor_m); }
  /// Squared error of the centre in its stated deviations; 2 on average.
  [[nodiscard]] double centre_nees() const {
    const Box b = box();
    const Eigen::Vector2d e = b.centre_m - truth.centre_m;
    return e.dot(b.covariance_m2.inverse() * e);
  }

  SimulatedObject truth;
  BoxEstimator estimator;
  BoxMemory memory;
  Component<double> component;
  Vector2<double> sensor_m;
  double road_rad = 0.0;  ///< heading of the own vehicle

 private:
  MotionParameters motion_;
  bool is_born_ = false;
  Random random_;
};

}  // namespace boresight::tracking::support
