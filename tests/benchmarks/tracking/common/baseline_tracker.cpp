#include "tests/benchmarks/tracking/common/baseline_tracker.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/LU>

#include "interfaces/messages/header.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::bench {

namespace {

constexpr std::size_t kNoCluster = static_cast<std::size_t>(-1);

/// Hits among the latest looks, of which each has a bit.
int hits_of(std::uint32_t looks, int latest) {
  return std::popcount(looks & static_cast<std::uint32_t>((std::uint64_t{1} << latest) - 1));
}

}  // namespace

BaselineTracker::BaselineTracker(const VehicleConfig& vehicle, const BaselineSettings& settings)
    : vehicle_(vehicle), settings_(settings), dbscan_(kMaxDetections) {}

Eigen::Matrix2d BaselineTracker::ego_rotation() const {
  const double c = std::cos(ego_heading_rad_), s = std::sin(ego_heading_rad_);
  Eigen::Matrix2d rotation;
  rotation << c, -s, s, c;
  return rotation;
}

bool BaselineTracker::is_moving(const BaselineDetection& detection, const BaselineScan& scan) const {
  const RadarConfig* const radar = vehicle_.radar(scan.radar);
  const SensorNoise noise = radar == nullptr ? SensorNoise{} : radar->noise;
  const Eigen::Vector2d sight = (detection.position_m - scan.sensor_m).normalized();
  // Of the expected range rate −u·v by the azimuth error: across the line of sight.
  const double across_mps = sight.x() * scan.sensor_velocity_mps.y() - sight.y() * scan.sensor_velocity_mps.x();
  const double by_azimuth = across_mps * noise.azimuth_std_rad;
  const double variance = noise.range_rate_std_mps * noise.range_rate_std_mps + by_azimuth * by_azimuth +
                          settings_.body_motion_std_mps * settings_.body_motion_std_mps;
  const double rate = detection.range_rate_over_ground_mps;
  return rate * rate > settings_.moving_sigma * settings_.moving_sigma * variance;
}

void BaselineTracker::move_ego(const BaselineScan& scan) {
  const double step_s = time_s_ ? std::max(0.0, scan.t_s - *time_s_) : 0.0;
  ego_heading_rad_ += 0.5 * step_s * scan.ego_yaw_rate_radps;
  ego_m_ += step_s * scan.ego_speed_mps * Eigen::Vector2d(std::cos(ego_heading_rad_), std::sin(ego_heading_rad_));
  ego_heading_rad_ += 0.5 * step_s * scan.ego_yaw_rate_radps;
  time_s_ = time_s_ ? std::max(*time_s_, scan.t_s) : scan.t_s;
  predict(step_s);
}

void BaselineTracker::predict(double step_s) {
  Eigen::Matrix4d transition = Eigen::Matrix4d::Identity();
  transition(0, 2) = transition(1, 3) = step_s;
  // Acceleration that is constant over a step and independent from step to step.
  Eigen::Matrix<double, 4, 2> gain;
  gain << 0.5 * step_s * step_s, 0.0, 0.0, 0.5 * step_s * step_s, step_s, 0.0, 0.0, step_s;
  const double variance = settings_.acceleration_std_mps2 * settings_.acceleration_std_mps2;
  const Eigen::Matrix4d noise = variance * gain * gain.transpose();
  for (State& track : states_) {
    track.mean = transition * track.mean;
    track.covariance = transition * track.covariance * transition.transpose() + noise;
  }
}

void BaselineTracker::find_clusters(const BaselineScan& scan) {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> rates;
  for (const BaselineDetection& detection : scan.detections) {
    if (!detection.position_m.allFinite() || !is_moving(detection, scan)) continue;
    points.push_back(detection.position_m);
    rates.push_back(detection.range_rate_over_ground_mps);
  }
  const std::size_t count = dbscan_.cluster(points, settings_.cluster_radius_m, settings_.cluster_min_points);
  clusters_.assign(count, {Eigen::Vector2d::Zero(), 0.0, 0});
  for (std::size_t i = 0; i < dbscan_.labels().size(); ++i) {
    if (dbscan_.labels()[i] == geometry::Dbscan::kNoise) continue;
    Cluster& cluster = clusters_[static_cast<std::size_t>(dbscan_.labels()[i])];
    cluster.position_m += points[i];
    cluster.range_rate_mps += rates[i];
    ++cluster.detections;
  }
  for (Cluster& cluster : clusters_) {
    const double n = cluster.detections;
    cluster.position_m = ego_m_ + ego_rotation() * (cluster.position_m / n);
    cluster.range_rate_mps /= n;
  }
}

void BaselineTracker::associate() {
  struct Pair {
    double distance;
    std::size_t track, cluster;
  };
  std::vector<Pair> pairs;
  const double variance = settings_.position_std_m * settings_.position_std_m;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const Eigen::Matrix2d innovation =
        states_[k].covariance.topLeftCorner<2, 2>() + variance * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d inverse = innovation.inverse();
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      const Eigen::Vector2d d = clusters_[c].position_m - states_[k].mean.head<2>();
      const double distance = d.dot(inverse * d);
      if (distance <= settings_.gate) pairs.push_back({distance, k, c});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  cluster_of_.assign(states_.size(), kNoCluster);
  is_taken_.assign(clusters_.size(), false);
  for (const Pair& pair : pairs) {
    if (cluster_of_[pair.track] != kNoCluster || is_taken_[pair.cluster]) continue;
    cluster_of_[pair.track] = pair.cluster;
    is_taken_[pair.cluster] = true;
  }
}

void BaselineTracker::update(State& track, const Cluster& cluster) const {
  const double variance = settings_.position_std_m * settings_.position_std_m;
  const Eigen::Matrix<double, 4, 2> cross = track.covariance.leftCols<2>();
  const Eigen::Matrix2d innovation = track.covariance.topLeftCorner<2, 2>() + variance * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 4, 2> gain = cross * innovation.inverse();
  track.mean += gain * (cluster.position_m - track.mean.head<2>());
  const Eigen::Matrix4d updated = track.covariance - gain * cross.transpose();
  track.covariance = 0.5 * (updated + updated.transpose());
}

BaselineTracker::State BaselineTracker::born(const Cluster& cluster, const BaselineScan& scan) {
  const Eigen::Vector2d sensor = ego_m_ + ego_rotation() * scan.sensor_m;
  const Eigen::Vector2d sight = (cluster.position_m - sensor).normalized();
  const Eigen::Vector2d across(-sight.y(), sight.x());
  State track{};
  track.id = next_id_++;
  track.born_s = track.updated_s = *time_s_;
  track.mean << cluster.position_m, cluster.range_rate_mps * sight;
  track.covariance.setZero();
  track.covariance.topLeftCorner<2, 2>() =
      settings_.position_std_m * settings_.position_std_m * Eigen::Matrix2d::Identity();
  track.covariance.bottomRightCorner<2, 2>() =
      settings_.radial_speed_std_mps * settings_.radial_speed_std_mps * sight * sight.transpose() +
      settings_.tangential_speed_std_mps * settings_.tangential_speed_std_mps * across * across.transpose();
  track.looks = 1;
  track.measured = true;
  track.detections = cluster.detections;
  return track;
}

bool BaselineTracker::sees(const BaselineScan& scan, const State& track) const {
  const RadarConfig* const radar = vehicle_.radar(scan.radar);
  if (radar == nullptr) return true;
  const Eigen::Vector2d place = ego_rotation().transpose() * (track.mean.head<2>() - ego_m_) - scan.sensor_m;
  const double azimuth_rad = geometry::wrap_angle(std::atan2(place.y(), place.x()) - radar->mounting_pose.yaw_rad);
  const FieldOfView& view = radar->field_of_view;
  // A radar that hangs upside down has left and right exchanged.
  const double seen_rad = std::cos(radar->mounting_pose.roll_rad) < 0.0 ? -azimuth_rad : azimuth_rad;
  return place.norm() < view.range_max_m && seen_rad > view.azimuth_min_rad && seen_rad < view.azimuth_max_rad;
}

void BaselineTracker::step(const BaselineScan& scan) {
  move_ego(scan);
  find_clusters(scan);
  associate();
  for (std::size_t k = 0; k < states_.size(); ++k) {
    State& track = states_[k];
    track.detections = 0;
    if (cluster_of_[k] != kNoCluster) {
      const Cluster& cluster = clusters_[cluster_of_[k]];
      update(track, cluster);
      track.looks = track.looks << 1 | 1U;
      track.misses = 0;
      track.updated_s = *time_s_;
      track.detections = cluster.detections;
      track.measured = true;
    } else if (sees(scan, track)) {
      track.looks = track.looks << 1;
      ++track.misses;
      track.measured = false;
    }
    if (hits_of(track.looks, settings_.confirm_looks) >= settings_.confirm_hits) track.confirmed = true;
  }
  std::erase_if(states_, [&](const State& track) {
    return track.misses >= settings_.delete_misses || *time_s_ - track.updated_s > settings_.longest_unseen_s;
  });
  for (std::size_t c = 0; c < clusters_.size() && states_.size() < kMaxTracks; ++c) {
    if (!is_taken_[c]) states_.push_back(born(clusters_[c], scan));
  }
}

std::vector<BaselineTrack> BaselineTracker::tracks() const {
  std::vector<BaselineTrack> tracks;
  const Eigen::Matrix2d to_vehicle = ego_rotation().transpose();
  Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
  turn.topLeftCorner<2, 2>() = turn.bottomRightCorner<2, 2>() = to_vehicle;
  for (const bool confirmed : {true, false}) {
    for (const State& state : states_) {
      if (state.confirmed != confirmed) continue;
      BaselineTrack& track = tracks.emplace_back();
      track.id = state.id;
      track.confirmed = confirmed;
      track.measured = state.measured;
      track.age_s = *time_s_ - state.born_s;
      track.since_update_s = *time_s_ - state.updated_s;
      track.position_m = to_vehicle * (state.mean.head<2>() - ego_m_);
      track.velocity_mps = to_vehicle * state.mean.tail<2>();
      track.covariance = turn * state.covariance * turn.transpose();
      track.detections = state.detections;
      track.hits = static_cast<std::uint32_t>(hits_of(state.looks, settings_.score_looks));
    }
  }
  return tracks;
}

}  // namespace boresight::bench
