#include "services/ghost_filter/core/origins/known_objects.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/extended_object/detection_count.hpp"
#include "services/common/extended_object/range_rate_model.hpp"
#include "services/common/geometry/ego_step.hpp"

namespace boresight::ghosts {

namespace {

using extended_object::RoadUserClass;

Eigen::Matrix2d block(const Track& track, std::size_t at) {
  const auto c = [&](std::size_t row, std::size_t column) {
    return static_cast<double>(track.covariance[(at + row) * kTrackStateSize + at + column]);
  };
  Eigen::Matrix2d m;
  m << c(0, 0), c(0, 1), c(1, 0), c(1, 1);
  return m.allFinite() ? m : Eigen::Matrix2d::Identity();
}

/// Of a covariance.
double largest_variance(const Eigen::Matrix2d& m) {
  const double difference = m(0, 0) - m(1, 1);
  return 0.5 * (m.trace() + std::sqrt(difference * difference + 4.0 * m(0, 1) * m(0, 1)));
}

RoadUserClass road_user_of(ObjectClass c) {
  switch (c) {
    case ObjectClass::kPedestrian:
      return RoadUserClass::kPedestrian;
    case ObjectClass::kTwoWheeler:
      return RoadUserClass::kTwoWheeler;
    case ObjectClass::kVan:
      return RoadUserClass::kVan;
    case ObjectClass::kTruck:
      return RoadUserClass::kTruck;
    case ObjectClass::kCar:
    case ObjectClass::kUnknown:
      break;
  }
  return RoadUserClass::kCar;
}

}  // namespace

void predict_objects(const TrackList& tracks, double elapsed_s, const ScanGeometry& geometry,
                     std::vector<KnownObject>& objects) {
  objects.clear();
  const geometry::EgoStep step = geometry::ego_step(static_cast<double>(geometry.ego_speed_mps),
                                                    static_cast<double>(geometry.ego_yaw_rate_radps), elapsed_s);
  const std::size_t count = std::min<std::size_t>(tracks.number_of_tracks, kMaxTracks);
  for (std::size_t i = 0; i < count && objects.size() < objects.capacity(); ++i) {
    const Track& t = tracks.tracks[i];
    const Eigen::Vector2d position(t.position_vehicle_m[0], t.position_vehicle_m[1]);
    const Eigen::Vector2d velocity(t.velocity_over_ground_mps[0], t.velocity_over_ground_mps[1]);
    const double values = position.sum() + velocity.sum() +
                          static_cast<double>(t.heading_rad + t.length_m + t.width_m + t.existence_probability);
    if (!std::isfinite(values)) continue;
    KnownObject o;
    o.observed.box.centre_m = step.move_point(position + elapsed_s * velocity);
    o.observed.box.heading_rad =
        static_cast<double>(t.heading_rad) - static_cast<double>(geometry.ego_yaw_rate_radps) * elapsed_s;
    o.observed.box.length_m = std::max(0.1, static_cast<double>(t.length_m));
    o.observed.box.width_m = std::max(0.1, static_cast<double>(t.width_m));
    o.observed.velocity_mps = step.rotate(velocity);
    const Eigen::Matrix2d of_velocity = block(t, 2);
    o.velocity_covariance_m2ps2 = step.to_new * of_velocity * step.to_new.transpose();
    o.position_covariance_m2 =
        step.to_new * (block(t, 0) + elapsed_s * elapsed_s * of_velocity) * step.to_new.transpose();
    o.road_user = road_user_of(t.object_class);
    o.existence = std::clamp(static_cast<double>(t.existence_probability), 0.0, 1.0);
    objects.push_back(o);
  }
}

double reach_m(const KnownObject& object, const IntensityConfig& config) {
  return kReachStds *
         std::sqrt(largest_variance(object.position_covariance_m2) + config.position_std_m * config.position_std_m);
}

ObjectIntensity::ObjectIntensity(const KnownObject& object, bool is_image, const Eigen::Vector2d& sensor_m,
                                 const extended_object::ObjectClassTable& classes, const IntensityConfig& config)
    : object_(&object),
      model_(&extended_object::model_of(classes, object.road_user)),
      config_(&config),
      to_box_(object.observed.box.rotation_to_box()),
      position_covariance_m2_(object.position_covariance_m2 +
                              config.position_std_m * config.position_std_m * Eigen::Matrix2d::Identity()),
      half_size_m_(object.observed.box.half_size_m()),
      ambiguous_share_(is_image ? 0.0 : config.ambiguous_share),
      reach_m_(reach_m(object, config)),
      speed_mps_(object.observed.velocity_mps.norm()) {
  const Eigen::Vector2d sensor_box = to_box_ * (sensor_m - object.observed.box.centre_m);
  const double range = std::max(0.1, sensor_box.norm());
  expected_ = object.existence * extended_object::expected_detections(model_->count, range, sensor_box / range);
  const extended_object::OrientedBox& box = object.observed.box;
  places_ = extended_object::reflection_mixture(model_->places, box.length_m, box.width_m, sensor_box);
}

double ObjectIntensity::at(const SeenDetection& d) const {
  const extended_object::OrientedBox& box = object_->observed.box;
  const double body_mps = d.direction.dot(object_->observed.velocity_mps) + object_->range_rate_offset_mps;
  const double variance = d.range_rate_variance_m2ps2 + config_->velocity_std_mps * config_->velocity_std_mps +
                          d.direction.dot(object_->velocity_covariance_m2ps2 * d.direction);
  const double rate = extended_object::range_rate_density(
      extended_object::range_rate_mixture(model_->micro_doppler, to_box_ * d.direction, body_mps, speed_mps_),
      d.range_rate_mps, variance);
  const double a = ambiguous_share_;
  const double at_rate = expected_ * ((1.0 - a) * rate + a / config_->ambiguous_width_mps);
  const Eigen::Matrix2d covariance = d.covariance_m2 + position_covariance_m2_;
  return at_rate * extended_object::position_density(places_, to_box_ * (d.position_m - box.centre_m),
                                                     to_box_ * covariance * to_box_.transpose());
}

}  // namespace boresight::ghosts
