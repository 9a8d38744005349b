#include "services/tracker/core/surroundings/path_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

constexpr std::size_t kMaxPlaces = 512;               // of the memory that are clustered
constexpr double kUniformHalf = std::numbers::sqrt3;  // half width of a uniform density by its standard deviation

/// Whether a place lies within a distance of the path: (W1) solved for the numerator, without its root.
bool is_within(const EgoPath& path, const Eigen::Vector2d& p, double distance_m) {
  const double k = path.curvature_per_m, twice_m = 2.0 * p.y() - k * p.squaredNorm();
  return twice_m < distance_m * (2.0 - k * distance_m) && twice_m > -distance_m * (2.0 + k * distance_m);
}

}  // namespace

double PathObstacle::half_extent_m(const Eigen::Vector2d& direction) const {
  return kUniformHalf * std::sqrt(std::max(0.0, direction.dot(spread_m2 * direction)));
}

PathObstacles::PathObstacles(const VehicleConfig& vehicle, const ObstacleParameters& parameters, double front_m)
    : parameters_(parameters), front_m_(front_m), clusters_(kMaxPlaces) {
  for (const RadarConfig& r : vehicle.radars) radars_.push_back({r.id, r.field_of_view});
  obstacles_.reserve(kMaxObstacles);
  owner_.reserve(kMaxDetections);
  places_.reserve(kMaxPlaces);
}

void PathObstacles::clear() {
  obstacles_.clear();
  for (Radar& r : radars_) {
    r.density_per_m2.fill(0.0);
    r.weight = 0.0;
  }
}

void PathObstacles::step(const ClassifiedScan& scan, const StationaryMemory& memory, const EgoPath& path,
                         const geometry::EgoStep& step, double elapsed_s) {
  move(step, elapsed_s);
  if (memory.radar() < 0) return;
  associate(memory, path);
  judge(scan, memory, path);
  for (std::size_t k = 0; k < obstacles_.size(); ++k) update(obstacles_[k], memory, k, elapsed_s);
  drop();
  learn_density(memory, path, radars_[static_cast<std::size_t>(memory.radar())], elapsed_s);
  if (!memory.places().empty() && scans_++ % static_cast<std::uint32_t>(parameters_.looks_per_search) == 0)
    start(memory, path);
}

void PathObstacles::move(const geometry::EgoStep& step, double elapsed_s) {
  const double time_s = std::max(0.0, elapsed_s);
  for (PathObstacle& o : obstacles_) {
    o.position_m = step.move_point(o.position_m);
    o.covariance_m2 = step.to_new * o.covariance_m2 * step.to_new.transpose() +
                      time_s * parameters_.position_density_m2ps * Eigen::Matrix2d::Identity();
    o.spread_m2 = step.to_new * o.spread_m2 * step.to_new.transpose();
    o.age_s += time_s;
    o.since_update_s += time_s;
    o.is_detected = false;
  }
}

void PathObstacles::associate(const StationaryMemory& memory, const EgoPath& path) {
  owner_.clear();
  for (const StationaryPoint& p : memory.scan()) {
    std::int32_t owner = -1;
    if (!obstacles_.empty() && is_within(path, p.position_m, parameters_.corridor_m)) {
      double nearest = 1.0;
      for (std::size_t k = 0; k < obstacles_.size(); ++k) {
        const double share = (p.position_m - obstacles_[k].position_m).norm() / parameters_.gate_m;
        if (share >= nearest) continue;
        nearest = share;
        owner = static_cast<std::int32_t>(k);
      }
    }
    owner_.push_back(owner);
  }
}

void PathObstacles::judge(const ClassifiedScan& scan, const StationaryMemory& memory, const EgoPath& path) {
  const Radar& radar = radars_[static_cast<std::size_t>(memory.radar())];
  const ScanGeometry& g = scan.geometry;
  const Eigen::Vector2d sensor_m(static_cast<double>(g.sensor_position_vehicle_m[0]),
                                 static_cast<double>(g.sensor_position_vehicle_m[1]));
  const double yaw_rad =
      std::atan2(static_cast<double>(g.sensor_to_vehicle[3]), static_cast<double>(g.sensor_to_vehicle[0]));
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    PathObstacle& o = obstacles_[k];
    const Eigen::Vector2d sight = o.position_m - sensor_m;
    const double range_m = std::max(1.0, sight.norm());
    const double azimuth_rad = geometry::wrap_angle(std::atan2(sight.y(), sight.x()) - yaw_rad);
    if (azimuth_rad < radar.view.azimuth_min_rad || azimuth_rad > radar.view.azimuth_max_rad ||
        range_m > radar.view.range_max_m) {
      continue;
    }
    double detections = 0.0, strength = 0.0;
    const double variance_db2 = parameters_.excess_std_db * parameters_.excess_std_db;
    for (std::size_t i = 0; i < owner_.size(); ++i) {
      if (owner_[i] != static_cast<std::int32_t>(k)) continue;
      detections += 1.0;
      const StationaryPoint& p = memory.scan()[i];
      // Equal deviations: the logarithm of the ratio is linear in the strength.
      if (p.has_strength)
        strength += parameters_.excess_db * (p.excess_db - 0.5 * parameters_.excess_db) / variance_db2;
    }
    const double along_m = std::max(0.0, path.place(o.position_m).along_m);
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(along_m / kBin_m));
    const double area_m2 = 4.0 * parameters_.gate_m * std::min(parameters_.corridor_m, parameters_.gate_m);
    const double usual = parameters_.background_factor * radar.density_per_m2[bin] * area_m2;
    const double background = parameters_.background_count + usual;
    const double vehicle =
        parameters_.count * std::pow(parameters_.count_range_m / range_m, parameters_.count_power) + usual;
    const double count = detections * std::log(vehicle / background) - (vehicle - background);
    o.log_odds +=
        parameters_.evidence_share * std::clamp(count + strength, -parameters_.most_of_scan, parameters_.most_of_scan);
    o.log_odds = std::min(o.log_odds, parameters_.most_log_odds);
  }
}

void PathObstacles::update(PathObstacle& o, const StationaryMemory& memory, std::size_t index, double elapsed_s) {
  const double keep = std::exp(-std::max(0.0, elapsed_s) / parameters_.extent_memory_s);
  o.spread_weight *= keep;
  for (std::size_t i = 0; i < owner_.size(); ++i) {
    if (owner_[i] != static_cast<std::int32_t>(index)) continue;
    const StationaryPoint& p = memory.scan()[i];
    const Eigen::Vector2d off = p.position_m - o.position_m;
    const Eigen::Matrix2d noise =
        p.covariance_m2 + parameters_.centre_std_m * parameters_.centre_std_m * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d gain = o.covariance_m2 * (o.covariance_m2 + noise).inverse();
    o.position_m += gain * off;
    o.covariance_m2 = o.covariance_m2 - gain * o.covariance_m2;
    o.covariance_m2 = 0.5 * (o.covariance_m2 + o.covariance_m2.transpose()).eval();
    o.spread_weight += 1.0;
    // What the radar's noise explains is no extent.
    const Eigen::Matrix2d square = off * off.transpose() - p.covariance_m2;
    o.spread_m2 += (square - o.spread_m2) / (1.0 + o.spread_weight);
    o.is_detected = true;
    o.since_update_s = 0.0;
  }
  for (Eigen::Index k = 0; k < 2; ++k) o.spread_m2(k, k) = std::max(o.spread_m2(k, k), 0.01);
}

void PathObstacles::drop() {
  std::erase_if(obstacles_, [this](const PathObstacle& o) {
    const bool is_double = std::any_of(obstacles_.begin(), obstacles_.end(), [&](const PathObstacle& other) {
      return other.id < o.id && (other.position_m - o.position_m).norm() < parameters_.gate_m;
    });
    return is_double || o.log_odds < parameters_.end_log_odds || o.since_update_s > parameters_.life_s ||
           o.position_m.x() < 0.0;
  });
}

void PathObstacles::learn_density(const StationaryMemory& memory, const EgoPath& path, Radar& radar, double elapsed_s) {
  std::array<double, kBins> count{};
  for (const StationaryPoint& p : memory.scan()) {
    if (!is_within(path, p.position_m, parameters_.corridor_m)) continue;
    const double along_m = path.place(p.position_m).along_m;
    if (along_m < 0.0) continue;
    const auto bin = static_cast<std::size_t>(along_m / kBin_m);
    if (bin < kBins) count[bin] += 1.0;
  }
  const double area_m2 = 2.0 * parameters_.corridor_m * kBin_m;
  // Each radar's scans come once for all radars' steps.
  const double passed_s = std::max(0.0, elapsed_s) * static_cast<double>(radars_.size());
  const double least = passed_s / parameters_.background_memory_s;
  radar.weight += 1.0;
  const double gain = std::max(std::min(1.0, least), 1.0 / radar.weight);
  for (std::size_t k = 0; k < kBins; ++k)
    radar.density_per_m2[k] += gain * (count[k] / area_m2 - radar.density_per_m2[k]);
}

void PathObstacles::start(const StationaryMemory& memory, const EgoPath& path) {
  places_.clear();
  for (const Eigen::Vector2d& p : memory.places()) {
    if (p.x() < front_m_ || places_.size() == kMaxPlaces) continue;
    if (is_within(path, p, parameters_.corridor_m)) places_.push_back(p);
  }
  const auto least = static_cast<std::size_t>(parameters_.least_detections);
  const std::size_t found = clusters_.cluster(places_, parameters_.cluster_radius_m, least);
  const auto labels = clusters_.labels();
  for (std::size_t c = 0; c < found && obstacles_.size() < kMaxObstacles; ++c) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    double n = 0.0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] != static_cast<std::int32_t>(c)) continue;
      mean += places_[i];
      square += places_[i] * places_[i].transpose();
      n += 1.0;
    }
    mean /= n;
    const bool is_known = std::any_of(obstacles_.begin(), obstacles_.end(), [&](const PathObstacle& o) {
      return (o.position_m - mean).norm() < parameters_.gate_m;
    });
    if (is_known) continue;
    PathObstacle o;
    o.id = next_id_++;
    if (next_id_ == 0) next_id_ = 1;
    o.position_m = mean;
    o.spread_m2 = square / n - mean * mean.transpose();
    o.spread_weight = std::min(n, parameters_.least_detections);
    o.covariance_m2 = parameters_.centre_std_m * parameters_.centre_std_m * Eigen::Matrix2d::Identity();
    o.log_odds = parameters_.prior_log_odds;
    obstacles_.push_back(o);
  }
}

}  // namespace boresight::tracking
