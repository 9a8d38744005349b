#include "tests/benchmarks/ghosts/common/load.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <Eigen/Core>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/benchmarks/common/statistics.hpp"
#include "tests/simulator/random.hpp"

namespace boresight::bench {

namespace {

constexpr std::int64_t kPeriod_ns = 50'000'000;
constexpr double kSpeed_mps = 25.0, kRail_m = 7.5;
constexpr std::array<std::array<double, 2>, 6> kVehicles = {
    {{25.0, 0.0}, {50.0, 3.5}, {-20.0, 0.0}, {12.0, -3.5}, {80.0, -3.5}, {-45.0, 3.5}}};

}  // namespace

GhostLoad::GhostLoad(std::size_t radars, std::size_t detections)
    : radars_(radars), detections_(std::min(detections, kMaxDetections)) {
  for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
    for (std::size_t radar = 0; radar < radars_; ++radar) {
      scans_.push_back(std::make_unique<CorrectedScan>());
      fill(*scans_.back(), cycle, radar);
    }
  }
  for (const auto& [x, y] : kVehicles) {
    Track& track = tracks_.tracks[tracks_.number_of_tracks++];
    track.tracking_id = tracks_.number_of_tracks;
    track.status = TrackStatus::kConfirmed;
    track.movement = MovementState::kMoving;
    track.existence_probability = 0.99F;
    track.position_vehicle_m = {static_cast<float>(x), static_cast<float>(y), 0.6F};
    track.velocity_over_ground_mps = {static_cast<float>(kSpeed_mps), 0.0F};
    track.length_m = 4.5F;
    track.width_m = 1.9F;
    for (std::size_t i = 0; i < kTrackStateSize; ++i) track.covariance[i * kTrackStateSize + i] = 0.1F;
  }
  tracks_.number_of_confirmed_tracks = tracks_.number_of_tracks;
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
  scan.number_of_valid_detections = static_cast<std::uint32_t>(detections_);
  const double reach_m = 100.0 * std::sqrt(static_cast<double>(radars_) / 4.0);
  for (std::size_t i = 0; i < detections_; ++i) {
    Eigen::Vector2d p;
    double along_mps = 0.0;
    if (i % 20 < 17) {
      const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
      const bool rail = random.uniform() < 0.5;
      p = {ahead * random.uniform(2.0, reach_m),
           side * (rail ? kRail_m + 0.1 * random.gaussian() : random.uniform(kRail_m + 2.0, 40.0))};
    } else {
      const auto& [x, y] = kVehicles[random.next() % kVehicles.size()];
      const double kind = random.uniform();
      p = {x + random.uniform(-2.2, 2.2), y + random.uniform(-0.9, 0.9)};
      if (kind > 0.5) p.y() = (kind > 0.75 ? 2.0 : -2.0) * kRail_m - p.y();
      along_mps = kSpeed_mps;
    }
    const Eigen::Vector2d sight = p - sensor;
    scan.x_vehicle_m[i] = static_cast<float>(p.x());
    scan.y_vehicle_m[i] = static_cast<float>(p.y());
    scan.z_vehicle_m[i] = 0.5F;
    scan.range_m[i] = static_cast<float>(sight.norm());
    scan.azimuth_vehicle_rad[i] = static_cast<float>(std::atan2(sight.y(), sight.x()));
    const double over_ground = along_mps * sight.x() / sight.norm();
    scan.range_rate_over_ground_mps[i] = static_cast<float>(over_ground + 0.05 * random.gaussian());
    scan.range_rate_mps[i] = static_cast<float>(over_ground - kSpeed_mps * sight.x() / sight.norm());
    scan.rcs_dbsm[i] = static_cast<float>(random.uniform(-10.0, 10.0));
    scan.range_std_m[i] = 0.1F;
    scan.azimuth_std_rad[i] = 0.005F;
    scan.elevation_std_rad[i] = 0.01F;
    scan.range_rate_std_mps[i] = 0.05F;
    scan.existence_probability[i] = 1.0F;
    scan.detection_flags[i] = along_mps > 0.0 ? corrected_flag::kMoving : corrected_flag::kStationary;
  }
}

std::size_t GhostLoad::give_cycle(ghosts::Method& method) {
  const std::size_t cycle = cycle_ % kCycles;
  for (std::size_t radar = 0; radar < radars_; ++radar) {
    CorrectedScan& scan = *scans_[cycle * radars_ + radar];
    scan.header.sequence = scan.header.source_sequence = cycle_ + 1;
    scan.header.measurement_time_ns =
        1'000'000'000 + static_cast<std::int64_t>(cycle_) * kPeriod_ns +
        static_cast<std::int64_t>(radar) * kPeriod_ns / static_cast<std::int64_t>(radars_);
    method.classify(scan, *out_);
    tracks_.header.measurement_time_ns = scan.header.measurement_time_ns;
    method.add_tracks(tracks_);
  }
  ++cycle_;
  return radars_ * detections_;
}

void GhostLoad::warm_up(ghosts::Method& method) {
  for (int i = 0; i < 30; ++i) give_cycle(method);
}

GhostCost measure_ghost_cycles(GhostLoad& load, ghosts::Method& method, std::size_t cycles) {
  using Clock = std::chrono::steady_clock;
  load.warm_up(method);
  std::vector<double> us(cycles);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (double& each : us) {
      const auto begin = Clock::now();
      load.give_cycle(method);
      each = 1e6 * std::chrono::duration<double>(Clock::now() - begin).count();
    }
  }
  const double cycle_us = median(us);
  return {cycle_us / static_cast<double>(load.scans_in_cycle()), cycle_us, runtime::counted_allocations() - before};
}

}  // namespace boresight::bench
