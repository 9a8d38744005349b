#include "services/tracker/core/surroundings/stationary_memory.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

StationaryMemory::StationaryMemory(const VehicleConfig& vehicle, const StationaryParameters& parameters,
                                   const ObstacleParameters& strengths)
    : parameters_(parameters), strengths_(strengths) {
  for (const RadarConfig& r : vehicle.radars) radars_.push_back({r.id, r.noise});
  scan_.reserve(kMaxDetections);
  ring_.reserve(kCapacity);
  places_.reserve(kCapacity);
}

void StationaryMemory::clear() {
  scan_.clear();
  ring_.clear();
  places_.clear();
  next_ = 0;
  axes_ = {};
  time_s_ = newest_s_ = 0.0;
  radar_ = -1;
}

double StationaryMemory::excess(Radar& radar, double range_m, double strength_db, double share) const {
  const auto k = std::min(kLevels - 1, static_cast<std::size_t>(range_m / strengths_.level_range_m));
  const double gain = std::max(share, 1.0 / (1.0 + radar.weight[k]));  // a mean of all until the memory is full
  radar.weight[k] += 1.0;
  const double before_db = radar.weight[k] > 1.0 ? radar.level_db[k] : strength_db;
  radar.level_db[k] = before_db + gain * (strength_db - before_db);
  return strength_db - before_db;
}

void StationaryMemory::read(const ClassifiedScan& scan, double elapsed_s) {
  scan_.clear();
  radar_ = -1;
  if ((scan.flags & (pipeline_flag::kDistrusted | pipeline_flag::kNoEgoMotion)) != 0) return;
  for (std::size_t k = 0; k < radars_.size(); ++k) {
    if (radars_[k].id == scan.header.source_id) radar_ = static_cast<int>(k);
  }
  if (radar_ < 0) return;
  Radar& radar = radars_[static_cast<std::size_t>(radar_)];
  ++scans_;
  const ScanGeometry& g = scan.geometry;
  const Eigen::Vector2d sensor_m(static_cast<double>(g.sensor_position_vehicle_m[0]),
                                 static_cast<double>(g.sensor_position_vehicle_m[1]));
  const bool has_height = (scan.fields & scan_field::kElevation) != 0;
  const bool has_strength = (scan.fields & scan_field::kRcs) != 0;
  // The share of one detection in the memory of a level: a scan's time over the memory, shared by its detections.
  const double count = std::max(1.0, static_cast<double>(scan.number_of_valid_detections));
  const double share = std::min(0.5, std::abs(elapsed_s) / (strengths_.level_memory_s * count));
  for (std::size_t i = 0; i < scan.number_of_valid_detections && i < kMaxDetections; ++i) {
    const std::uint16_t flags = scan.detection_flags[i];
    if ((flags & corrected_flag::kStationary) == 0 || (flags & corrected_flag::kRejected) != 0) continue;
    if (static_cast<double>(scan.probability(Provenance::kStationary, i)) < parameters_.least_probability) continue;
    StationaryPoint p;
    p.position_m = {static_cast<double>(scan.x_vehicle_m[i]), static_cast<double>(scan.y_vehicle_m[i])};
    const auto height_m = static_cast<double>(scan.z_vehicle_m[i]);
    p.range_m = static_cast<double>(scan.range_m[i]);
    if (!std::isfinite(p.position_m.x() + p.position_m.y() + p.range_m) || p.range_m <= 0.0) continue;
    if (p.position_m.x() < -parameters_.behind_m || p.position_m.x() > parameters_.ahead_m ||
        std::abs(p.position_m.y()) > parameters_.aside_m) {
      continue;
    }
    if (has_height && !(height_m >= parameters_.lowest_m && height_m <= parameters_.highest_m)) continue;
    const auto strength_db = static_cast<double>(scan.rcs_dbsm[i]);
    p.has_strength = has_strength && std::isfinite(strength_db);
    if (p.has_strength) p.excess_db = excess(radar, p.range_m, strength_db, share);
    // Across the line of sight the radar's own error and that of its mounting add up.
    const auto std_or = [](float stated, double usual) { return stated > 0.0F ? static_cast<double>(stated) : usual; };
    const double range_std_m = std_or(scan.range_std_m[i], radar.noise.range_std_m);
    const double azimuth_std_rad = std_or(scan.azimuth_std_rad[i], radar.noise.azimuth_std_rad);
    const Eigen::Vector2d sight = (p.position_m - sensor_m).stableNormalized(), across(-sight.y(), sight.x());
    const double across_m2 =
        p.range_m * p.range_m *
        (azimuth_std_rad * azimuth_std_rad + parameters_.mounting_std_rad * parameters_.mounting_std_rad);
    p.covariance_m2 = range_std_m * range_std_m * sight * sight.transpose() + across_m2 * across * across.transpose();
    p.scan = scans_;
    scan_.push_back(p);
  }
}

void StationaryMemory::step(const ClassifiedScan& scan, const geometry::EgoStep& step, double yaw_rad,
                            double elapsed_s) {
  const double c0 = std::cos(axes_.heading_rad), s0 = std::sin(axes_.heading_rad);
  axes_.position_m += Eigen::Vector2d(c0 * step.translation_m.x() - s0 * step.translation_m.y(),
                                      s0 * step.translation_m.x() + c0 * step.translation_m.y());
  axes_.heading_rad = geometry::wrap_angle(axes_.heading_rad + yaw_rad);
  time_s_ += elapsed_s;
  newest_s_ = std::max(newest_s_, time_s_);
  read(scan, elapsed_s);
  const double c = std::cos(axes_.heading_rad), s = std::sin(axes_.heading_rad);
  for (const StationaryPoint& p : scan_) {
    const Remembered r{axes_.position_m + Eigen::Vector2d(c * p.position_m.x() - s * p.position_m.y(),
                                                          s * p.position_m.x() + c * p.position_m.y()),
                       time_s_};
    if (ring_.size() < kCapacity) {
      ring_.push_back(r);
    } else {
      ring_[next_] = r;
    }
    next_ = (next_ + 1) % kCapacity;
  }
  places_.clear();
  if (radar_ < 0 || scans_ % static_cast<std::uint32_t>(parameters_.scans_per_look) != 0) return;
  for (const Remembered& r : ring_) {
    if (newest_s_ - r.time_s > parameters_.memory_s) continue;
    const Eigen::Vector2d d = r.standing_m - axes_.position_m;
    places_.emplace_back(c * d.x() + s * d.y(), c * d.y() - s * d.x());
  }
}

}  // namespace boresight::tracking
