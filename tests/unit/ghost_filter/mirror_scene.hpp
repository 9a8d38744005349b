// A vehicle with one radar that drives straight among mirrors, and what the mirror method says of what it detects.
#pragma once

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/ghost_filter/core/classify/mirror_filter.hpp"

namespace boresight::ghosts {

inline constexpr std::int64_t kMillisecond = 1'000'000;
using Eigen::Vector2d;

/// A plane mirror: a point on it, its direction, its velocity.
struct Plane {
  Vector2d point, tangent, velocity{0.0, 0.0};
  [[nodiscard]] Vector2d normal() const { return {-tangent.y(), tangent.x()}; }
  [[nodiscard]] Vector2d image(const Vector2d& p) const { return p - 2.0 * normal().dot(p - point) * normal(); }
  [[nodiscard]] Vector2d image_velocity(const Vector2d& v) const {
    return v - 2.0 * normal().dot(v - velocity) * normal();
  }
};

/// The vehicle drives straight; vehicle frame and world frame have the same axes, apart by the way driven.
class MirrorFilterTest : public testing::Test {
 protected:
  MirrorFilterTest() {
    std::memset(static_cast<void*>(out_.get()), 0xCD, sizeof(ClassifiedScan));
    std::memset(static_cast<void*>(scan_.get()), 0, sizeof(CorrectedScan));
    std::memset(static_cast<void*>(tracks_.get()), 0, sizeof(TrackList));
  }
  void begin() {
    scan_->header.source_id = 1;
    scan_->header.measurement_time_ns = start_ + static_cast<std::int64_t>(t_s_ * 1e9);
    scan_->fields = scan_field::kRcs;
    scan_->number_of_valid_detections = 0;
    scan_->geometry.sensor_position_vehicle_m = {3.6F, 0.0F, 0.5F};
    scan_->geometry.sensor_velocity_vehicle_mps = {static_cast<float>(speed_mps_), 0.0F, 0.0F};
    scan_->geometry.ego_speed_mps = static_cast<float>(speed_mps_);
    scan_->geometry.ego_speed_std_mps = 0.03F;
    scan_->geometry.ego_yaw_rate_std_radps = 0.002F;
  }
  [[nodiscard]] Vector2d sensor() const { return {3.6, 0.0}; }
  [[nodiscard]] Vector2d sensor_velocity() const { return {speed_mps_, 0.0}; }

  /// What is measured in `direction` at `range` with a range rate that is as measured, not over ground.
  std::uint32_t add(const Vector2d& direction, double range, double range_rate, double rcs, std::uint16_t flags) {
    const std::uint32_t i = scan_->number_of_valid_detections++;
    std::normal_distribution<double> noise;
    const double azimuth = std::atan2(direction.y(), direction.x()) + 0.004 * noise(random_);
    const double seen_at = range + 0.1 * noise(random_);
    scan_->x_vehicle_m[i] = static_cast<float>(sensor().x() + seen_at * std::cos(azimuth));
    scan_->y_vehicle_m[i] = static_cast<float>(sensor().y() + seen_at * std::sin(azimuth));
    scan_->range_m[i] = static_cast<float>(seen_at);
    scan_->range_rate_over_ground_mps[i] =
        static_cast<float>(range_rate + 0.05 * noise(random_) + direction.dot(sensor_velocity()));
    scan_->rcs_dbsm[i] = static_cast<float>(rcs);
    scan_->range_std_m[i] = 0.1F;
    scan_->azimuth_std_rad[i] = 0.004F;
    scan_->range_rate_std_mps[i] = 0.05F;
    scan_->detection_flags[i] = flags;
    return i;
  }
  std::uint32_t direct(const Vector2d& p, const Vector2d& v, double rcs = 8.0) {
    const Vector2d sight = p - sensor();
    return add(sight.normalized(), sight.norm(), sight.normalized().dot(v - sensor_velocity()), rcs,
               corrected_flag::kMoving);
  }
  std::uint32_t still(const Vector2d& p) {
    const Vector2d sight = p - sensor();
    return add(sight.normalized(), sight.norm(), -sight.normalized().dot(sensor_velocity()), 0.0,
               corrected_flag::kStationary);
  }
  std::uint32_t by_three_bounces(const Vector2d& p, const Vector2d& v, const Plane& plane) {
    const Vector2d sight = plane.image(p) - sensor();
    return add(sight.normalized(), sight.norm(), sight.normalized().dot(plane.image_velocity(v) - sensor_velocity()),
               -8.0, corrected_flag::kMoving);
  }
  /// Of two bounces: in the direction of the target (type 1) or of its image (type 2).
  std::uint32_t by_two_bounces(const Vector2d& p, const Vector2d& v, const Plane& plane, bool type1,
                               double rcs = -8.0) {
    const Vector2d direct_sight = p - sensor(), image_sight = plane.image(p) - sensor();
    const double rate = 0.5 * (direct_sight.normalized().dot(v - sensor_velocity()) +
                               image_sight.normalized().dot(plane.image_velocity(v) - sensor_velocity()));
    return add((type1 ? direct_sight : image_sight).normalized(), 0.5 * (direct_sight.norm() + image_sight.norm()),
               rate, rcs, corrected_flag::kMoving);
  }
  /// The rail's posts every two metres along y = `y`, of which a scan shows some.
  void rail(
      double y, const std::function<bool(double)>& is_there = [](double) { return true; }) {
    std::uniform_real_distribution<double> chance;
    std::normal_distribution<double> noise(0.0, 0.04);
    const double driven = t_s_ * speed_mps_;
    for (double world = std::ceil((driven - 40.0) / 2.0) * 2.0; world < driven + 80.0; world += 2.0) {
      if (!is_there(world) || chance(random_) > 0.5) continue;
      still({world - driven, y + noise(random_)});
    }
  }
  void track(const Vector2d& p, const Vector2d& v, double length = 4.5, double width = 1.8, double variance = 0.1,
             double age_s = 5.0) {
    Track& t = tracks_->tracks[tracks_->number_of_tracks++];
    t = {};
    t.tracking_id = tracks_->number_of_tracks;
    t.status = TrackStatus::kConfirmed;
    t.existence_probability = 0.99F;
    t.position_vehicle_m = {static_cast<float>(p.x()), static_cast<float>(p.y()), 0.5F};
    t.velocity_over_ground_mps = {static_cast<float>(v.x()), static_cast<float>(v.y())};
    t.heading_rad = static_cast<float>(std::atan2(v.y(), v.x()));
    t.length_m = static_cast<float>(length);
    t.width_m = static_cast<float>(width);
    for (std::size_t k = 0; k < kTrackStateSize; ++k)
      t.covariance[k * kTrackStateSize + k] = static_cast<float>(variance);
    t.age_s = static_cast<float>(age_s);
  }
  void hand_over_tracks() {
    tracks_->header.measurement_time_ns = start_ + static_cast<std::int64_t>(t_s_ * 1e9);
    filter_->add_tracks(*tracks_);
    tracks_->number_of_tracks = 0;
  }
  void classify() { filter_->classify(*scan_, *out_); }
  /// `seconds` of scans of what `fill` adds, 20 a second; the last one is left to be looked at.
  void drive(double seconds, const std::function<void()>& fill) {
    for (int k = 0; k < static_cast<int>(seconds * 20.0); ++k) {
      t_s_ += 0.05;
      begin();
      fill();
      classify();
    }
  }
  [[nodiscard]] Provenance label(std::uint32_t i) const { return out_->provenance[i]; }

  std::unique_ptr<MirrorFilter> filter_ = std::make_unique<MirrorFilter>(MirrorConfig{});
  std::mt19937 random_{1};
  std::unique_ptr<CorrectedScan> scan_ = std::make_unique<CorrectedScan>();
  std::unique_ptr<ClassifiedScan> out_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  std::int64_t start_ = 1'000'000 * kMillisecond;
  double t_s_ = 0.0;
  double speed_mps_ = 20.0;
};

}  // namespace boresight::ghosts
