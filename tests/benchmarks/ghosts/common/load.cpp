#include "tests/benchmarks/ghosts/common/load.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <time.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/simulator/random.hpp"
#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

namespace {

constexpr std::int64_t kPeriod_ns = 50'000'000;
constexpr double kSpeed_mps = 25.0, kRail_m = 7.5;
constexpr double kRoad_m = 100.0;  // period of the world's repetition: kCycles cycles at kSpeed_mps
constexpr double kReach_m = 100.0, kHalfWidth_m = 40.0;
constexpr double kLane_m = 3.5;                            // of the vehicles, on either side
constexpr std::size_t kRealOf100 = 10, kMovingOf100 = 20;  // the others of the moving ones are false
/// Stationary reflection points per kRoad_m. Noise and changing aspect angles spread each of them over several points
/// of the map.
constexpr double kPlaces = 890.0;
constexpr double kAzimuthStd_rad = 0.003, kRangeStd_m = 0.1;

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

GhostLoad::GhostLoad(std::size_t radars, std::size_t detections)
    : radars_(radars), detections_(std::min(detections, kMaxDetections)) {
  build_world();
  build_tracks();
  for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
    for (std::size_t radar = 0; radar < radars_; ++radar) {
      scans_.push_back(std::make_unique<CorrectedScan>());
      fill(*scans_.back(), cycle, radar);
    }
  }
}

void GhostLoad::build_tracks() {
  constexpr std::size_t kInLane = kVehicles / 2;
  constexpr double kSpacing_m = 2.0 * kReach_m / static_cast<double>(kInLane);
  for (std::size_t k = 0; k < kInLane; ++k) {
    const double x = -kReach_m + (static_cast<double>(k) + 0.5) * kSpacing_m;
    vehicles_.emplace_back(x, kLane_m);
    vehicles_.emplace_back(x, -kLane_m);
  }
  for (const Eigen::Vector2d& vehicle : vehicles_) {
    Track& track = tracks_.tracks[tracks_.number_of_tracks++];
    track.tracking_id = tracks_.number_of_tracks;
    track.status = TrackStatus::kConfirmed;
    track.movement = MovementState::kMoving;
    track.existence_probability = 0.99F;
    track.position_vehicle_m = {static_cast<float>(vehicle.x()), static_cast<float>(vehicle.y()), 0.6F};
    track.velocity_over_ground_mps = {static_cast<float>(kSpeed_mps), 0.0F};
    track.length_m = 4.5F;
    track.width_m = 1.9F;
    for (std::size_t i = 0; i < kTrackStateSize; ++i) track.covariance[i * kTrackStateSize + i] = 0.1F;
  }
  tracks_.number_of_confirmed_tracks = tracks_.number_of_tracks;
}

void GhostLoad::build_world() {
  simulator::Stream random(7, "load world");
  for (double x = 0.0; x < kRoad_m; x += 1.0) {
    world_.emplace_back(x, kRail_m);
    world_.emplace_back(x, -kRail_m);
  }
  for (double x = 20.0; x < 60.0; x += 0.5) world_.emplace_back(x, 14.0);
  for (double x = 5.0; x < 35.0; x += 6.0) {
    for (double along = 0.0; along < 4.5; along += 0.9) {
      world_.emplace_back(x + along, -11.0);
      world_.emplace_back(x + along, -12.8);
    }
  }
  for (double x = 0.0; x < kRoad_m; x += 25.0) world_.emplace_back(x, 9.0);
  // Bushes: dense clusters farther from the road.
  const auto places = static_cast<std::size_t>(kPlaces);
  while (world_.size() < places) {
    const Eigen::Vector2d middle(random.uniform(0.0, kRoad_m),
                                 (random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(18.0, kHalfWidth_m));
    for (int leaf = 0; leaf < 12; ++leaf) {
      world_.push_back(middle + Eigen::Vector2d(1.2 * random.gaussian(), 1.2 * random.gaussian()));
    }
  }
}

void GhostLoad::fill(CorrectedScan& scan, std::size_t cycle, std::size_t radar) const {
  simulator::Stream random(7, "load", cycle, radar);
  scan = {};
  scan.header.source_id = static_cast<std::uint32_t>(radar + 1);
  scan.fields = scan_field::kElevation | scan_field::kRcs | scan_field::kStds;
  scan.alignment_sequence = 1;
  scan.mounting_covariance = {1e-6F, 0.0F, 0.0F, 1e-6F, 0.0F, 1e-7F};
  const double angle = 2.0 * M_PI * (static_cast<double>(radar) + 0.5) / static_cast<double>(radars_);
  const double ahead = std::cos(angle) >= 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d sensor(ahead > 0.0 ? 3.6 : -0.9, std::sin(angle) >= 0.0 ? 0.7 : -0.7);
  scan.geometry.sensor_position_vehicle_m = {static_cast<float>(sensor.x()), static_cast<float>(sensor.y()), 0.5F};
  scan.geometry.sensor_velocity_vehicle_mps = {static_cast<float>(kSpeed_mps), 0.0F, 0.0F};
  scan.geometry.sensor_to_vehicle = {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  scan.geometry.speed_scale = 1.0F;
  scan.geometry.ego_speed_mps = static_cast<float>(kSpeed_mps);
  scan.geometry.ego_speed_std_mps = 0.03F;
  scan.geometry.ego_yaw_rate_std_radps = 0.002F;
  scan.number_of_valid_detections = static_cast<std::uint32_t>(detections_);
  const double driven_m = kSpeed_mps * 1e-9 *
                          (static_cast<double>(cycle) * kPeriod_ns +
                           static_cast<double>(radar) * kPeriod_ns / static_cast<double>(radars_));
  for (std::size_t i = 0; i < detections_; ++i) {
    Eigen::Vector2d p;
    double along_mps = 0.0, false_mps = 0.0, rcs_dbsm = random.uniform(-10.0, 10.0);
    const bool is_moving = i % 100 < kMovingOf100, is_real = i % 100 < kRealOf100;
    if (!is_moving) {
      // In the field of view, ahead of the vehicle or behind it.
      const double low = ahead > 0.0 ? 0.0 : -kReach_m;
      const Eigen::Vector2d& place = world_[random.next() % world_.size()];
      p = {low + std::fmod(place.x() - driven_m - low + 1e4 * kRoad_m, kRoad_m), place.y()};
    } else if (is_real || i % 2 == 0) {
      p = vehicles_[random.next() % vehicles_.size()];
      // On the faces that point towards the ego vehicle.
      const double inwards = p.y() > 0.0 ? -0.9 : 0.9;
      p += random.uniform() < 0.5 ? Eigen::Vector2d(p.x() > 0.0 ? -2.2 : 2.2, random.uniform(-0.9, 0.9))
                                  : Eigen::Vector2d(random.uniform(-2.2, 2.2), inwards);
      rcs_dbsm = 5.0 + 6.0 * random.gaussian();
      if (!is_real) {
        // A mirror image loses 13 dB at each of its two bounces on a mirror.
        rcs_dbsm -= 26.0;
        p.y() = (p.y() > 0.0 ? 2.0 : -2.0) * kRail_m - p.y();
      }
      along_mps = kSpeed_mps;
    } else {
      p = {random.uniform(-kReach_m, kReach_m), random.uniform(-kHalfWidth_m, kHalfWidth_m)};
      false_mps = random.uniform(3.0, 30.0);
    }
    Eigen::Vector2d sight = p - sensor;
    sight += kRangeStd_m * random.gaussian() * sight.normalized() +
             kAzimuthStd_rad * random.gaussian() * Eigen::Vector2d(-sight.y(), sight.x());
    p = sensor + sight;
    scan.x_vehicle_m[i] = static_cast<float>(p.x());
    scan.y_vehicle_m[i] = static_cast<float>(p.y());
    scan.z_vehicle_m[i] = 0.5F;
    scan.range_m[i] = static_cast<float>(sight.norm());
    scan.azimuth_vehicle_rad[i] = static_cast<float>(std::atan2(sight.y(), sight.x()));
    const double over_ground = along_mps * sight.x() / sight.norm() + false_mps;
    scan.range_rate_over_ground_mps[i] = static_cast<float>(over_ground + 0.05 * random.gaussian());
    scan.range_rate_mps[i] = static_cast<float>(over_ground - kSpeed_mps * sight.x() / sight.norm());
    scan.rcs_dbsm[i] = static_cast<float>(rcs_dbsm);
    scan.range_std_m[i] = static_cast<float>(kRangeStd_m);
    scan.azimuth_std_rad[i] = static_cast<float>(kAzimuthStd_rad);
    scan.elevation_std_rad[i] = 0.01F;
    scan.range_rate_std_mps[i] = 0.05F;
    scan.existence_probability[i] = 1.0F;
    scan.detection_flags[i] = is_moving ? corrected_flag::kMoving : corrected_flag::kStationary;
  }
}

const CorrectedScan& GhostLoad::next_scan(std::size_t radar) {
  CorrectedScan& scan = *scans_[(cycle_ % kCycles) * radars_ + radar];
  scan.header.sequence = scan.header.source_sequence = cycle_ + 1;
  scan.header.measurement_time_ns = 1'000'000'000 + static_cast<std::int64_t>(cycle_) * kPeriod_ns +
                                    static_cast<std::int64_t>(radar) * kPeriod_ns / static_cast<std::int64_t>(radars_);
  tracks_.header.measurement_time_ns = scan.header.measurement_time_ns;
  return scan;
}

void GhostLoad::warm_up(ghosts::Method& method) {
  for (int i = 0; i < 40; ++i) give_cycle(method, [](std::size_t) {});
}

GhostCost measure_ghost_cycles(GhostLoad& load, ghosts::Method& method, std::size_t cycles) {
  load.warm_up(method);
  std::vector<double> us;
  us.reserve(cycles * load.scans_in_cycle());
  GhostCost cost{};
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (std::size_t i = 0; i < cycles; ++i) {
      double begin_s = thread_seconds();
      load.give_cycle(method, [&](std::size_t) {
        us.push_back(1e6 * (thread_seconds() - begin_s));
        begin_s = thread_seconds();
      });
      cost.map_points += static_cast<double>(method.map_points()) / static_cast<double>(cycles);
    }
  }
  const auto scans = static_cast<double>(us.size());
  cost.allocations = runtime::counted_allocations() - before;
  for (const double each : us) cost.mean_us += each / scans;
  cost.p99_us = quantile(us, 0.99);
  cost.max_us = quantile(us, 1.0);
  return cost;
}

}  // namespace boresight::bench
