#include "services/ghost_filter/core/classify/predicted_object.hpp"

#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/classify/measured.hpp"

namespace boresight::ghosts {

namespace {

Eigen::Matrix2d block(const Track& track, std::size_t at) {
  const auto c = [&](std::size_t row, std::size_t column) {
    return static_cast<double>(track.covariance[(at + row) * kTrackStateSize + at + column]);
  };
  Eigen::Matrix2d m;
  m << c(0, 0), c(0, 1), c(1, 0), c(1, 1);
  return m.allFinite() ? m : Eigen::Matrix2d::Identity();
}

}  // namespace

std::optional<Object> predicted(const Track& track, const TrackBelief& belief, double elapsed_s,
                                const geometry::EgoStep& step, double tentative_weight) {
  const Eigen::Vector2d position(track.position_vehicle_m[0], track.position_vehicle_m[1]);
  const Eigen::Vector2d velocity(track.velocity_over_ground_mps[0], track.velocity_over_ground_mps[1]);
  if (track.tracking_id == 0 || !position.allFinite() || !velocity.allFinite() || !std::isfinite(track.heading_rad)) {
    return std::nullopt;
  }
  Object o;
  o.position_m = step.move_point(position + elapsed_s * velocity);
  o.axis =
      step.rotate({std::cos(static_cast<double>(track.heading_rad)), std::sin(static_cast<double>(track.heading_rad))});
  o.half_length_m = 0.5 * positive_or(track.length_m, 4.0);
  o.half_width_m = 0.5 * positive_or(track.width_m, 1.8);
  o.velocity_mps = step.rotate(velocity);
  const Eigen::Matrix2d of_velocity = block(track, 2) + 4.0 * elapsed_s * elapsed_s * Eigen::Matrix2d::Identity();
  o.position_covariance =
      step.to_new * (block(track, 0) + elapsed_s * elapsed_s * of_velocity) * step.to_new.transpose();
  o.velocity_covariance = step.to_new * of_velocity * step.to_new.transpose();
  const double existence = std::isfinite(track.existence_probability)
                               ? std::clamp(static_cast<double>(track.existence_probability), 0.5, 1.0)
                               : 0.5;
  const double existing = track.status == TrackStatus::kConfirmed ? existence : existence * tentative_weight;
  o.weight = existing / (1.0 + std::exp(2.0 * belief.log_odds));
  o.image = existing - o.weight;
  o.rcs_dbsm = belief.rcs_dbsm;
  o.rcs_std_db = belief.rcs_std_db;
  o.moving = moving_of(o);
  o.mirrors = belief.mirrors;
  o.age_s = track.age_s;
  return o;
}

Object own_vehicle(const ClassConfig& config, const ScanGeometry& geometry) {
  Object own;
  own.own = true;
  own.weight = 1.0;
  own.position_m = {0.5 * (config.ego_front_m + config.ego_rear_m), 0.0};
  own.half_length_m = 0.5 * (config.ego_front_m - config.ego_rear_m);
  own.half_width_m = config.ego_half_width_m;
  own.velocity_mps = {geometry.ego_speed_mps, geometry.ego_yaw_rate_radps * own.position_m.x()};
  own.velocity_covariance = 0.04 * Eigen::Matrix2d::Identity();
  return own;
}

}  // namespace boresight::ghosts
