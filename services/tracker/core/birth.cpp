#include "services/tracker/core/birth.hpp"

#include <cmath>
#include <optional>

#include "services/tracker/core/heading.hpp"

namespace boresight::tracking {

namespace {

/// Velocity over ground of what is new, and its covariance; its heading where the road tells it.
void begin_velocity(KinematicState& state, const Cluster& cluster, const OwnRoad& road, const RulesConfig& config) {
  constexpr double kMoves_mps = 0.5, kAside_mps = 1.5;  // who changes lanes, or walks across
  const Eigen::Vector2d& sight = cluster.line_of_sight;
  const double rate_mps = cluster.range_rate_over_ground_mps;
  const double speed2 = config.start_speed_std_mps * config.start_speed_std_mps;
  const double rate2 = cluster.range_rate_variance + config.range_rate_std_mps * config.range_rate_std_mps;
  const std::optional<double> along_rad = road.heading_rad(cluster.position_m);
  if (!along_rad || std::abs(rate_mps) < kMoves_mps) {
    const Eigen::Vector2d across(-sight.y(), sight.x());
    state.mean.segment<2>(2) = rate_mps * sight;
    state.covariance.block<2, 2>(2, 2) = rate2 * sight * sight.transpose() + speed2 * across * across.transpose();
    return;
  }
  const Eigen::Vector2d along(std::cos(*along_rad), std::sin(*along_rad)), aside(-along.y(), along.x());
  state.mean.segment<2>(2) = rate_mps / along.dot(sight) * along;
  state.covariance.block<2, 2>(2, 2) =
      speed2 * along * along.transpose() + kAside_mps * kAside_mps * aside * aside.transpose();
  update_rate(state, sight, rate_mps, rate2);
  begin_heading(state, *along_rad);
}

}  // namespace

TrackedObject new_track(const Cluster& cluster, const Eigen::Vector2d& sensor_m, bool has_elevation,
                        const OwnRoad& road, const RulesConfig& config) {
  TrackedObject track;
  Extent& extent = track.extent;
  Vector6d& mean = track.state.mean;
  track.state.covariance.setZero();
  const double centre2 =
      config.start_position_std_m * config.start_position_std_m + config.centre_std_m * config.centre_std_m;
  track.state.covariance.topLeftCorner<2, 2>() = cluster.covariance_m2 + centre2 * Eigen::Matrix2d::Identity();
  begin_velocity(track.state, cluster, road, config);
  const double acceleration2 = config.start_acceleration_std_mps2 * config.start_acceleration_std_mps2;
  track.state.covariance.bottomRightCorner<2, 2>() = acceleration2 * Eigen::Matrix2d::Identity();
  extent.heading_rad = std::atan2(mean(3), mean(2));
  if (cluster.number_on_outline > 0) extent.hear(cluster.strongest_dbsm, mean.segment<2>(2).norm());
  mean.head<2>() = cluster.position_m;
  if (!extent.is_small) {
    // What is seen is of the faces.
    const VisibleFaces faces = extent.visible_faces(cluster.position_m, sensor_m);
    mean.head<2>() -= extent.from_body({0.5 * faces.end * extent.length_m, 0.5 * faces.side * extent.width_m});
  }
  mean.head<2>() += extent.update(cluster, mean.head<2>(), mean.segment<2>(2), sensor_m, has_elevation);
  track.history = 1;
  track.evidence[0] = static_cast<float>(cluster.realness);
  track.seen_scans = 1;
  track.detections = cluster.number_of_detections;
  return track;
}

}  // namespace boresight::tracking
