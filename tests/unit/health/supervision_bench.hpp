// A vehicle with two radars under supervision, and messages for it.
#pragma once

#include <array>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "interfaces/catalogue/catalogue.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/health/core/supervision.hpp"

namespace boresight::health {

using catalogue::Service;
constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kStart = 1'000'000 * kMillisecond;
constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;  // of the wall clock at monotonic time 0

inline VehicleConfig two_radars() {
  VehicleConfig vehicle;
  vehicle.name = "test";
  for (std::uint32_t id : {1u, 2u}) {
    RadarConfig radar;
    radar.id = id;
    radar.name = id == 1 ? "left" : "right";
    radar.tolerance = {
        .yaw_rad = 1.5 * kRadiansPerDegree, .pitch_rad = 1.5 * kRadiansPerDegree, .roll_rad = 3.0 * kRadiansPerDegree};
    radar.cycle_time_s = 0.05;
    radar.deadline_s = 0.25;
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

/// A healthy system of two radars and six services. A test stops parts of it.
class SupervisionTest : public testing::Test {
 protected:
  SupervisionTest() {
    for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
      status_[i].header.source_id = static_cast<std::uint32_t>(i);
      status_[i].incarnation_ns = kStart - 100 * kMillisecond;
      status_[i].state = ServiceState::kRunning;
    }
    status_[0].sources[0].source_id = 1;
    status_[0].sources[1].source_id = 2;
    for (auto& estimate : estimate_) {
      estimate.state = AlignmentState::kConverged;
      estimate.observable = alignment_axis::kSpeedScale | alignment_axis::kYaw;
      estimate.speed_scale = 1.0F;
      estimate.covariance = {};
      estimate.covariance[5] = static_cast<float>(0.02 * kRadiansPerDegree * 0.02 * kRadiansPerDegree);
    }
    estimate_[0].header.source_id = 1;
    estimate_[1].header.source_id = 2;
  }

  /// The vehicle moves from now on.
  void drive(float speed_mps) {
    EgoMotion motion{};
    motion.fields = ego_field::kSpeed | ego_field::kYawRate;
    motion.speed_mps = speed_mps_ = speed_mps;
    supervision_.observe(motion);
  }
  /// A radar's scan: reflectors ahead, and random detections of interference.
  void fill(std::uint32_t id) {
    std::uniform_real_distribution<float> range_m(1.0F, 150.0F), range_rate_mps(-80.0F, 80.0F);
    scan_->number_of_valid_detections = detections_[id] + interference_[id];
    for (std::uint32_t i = 0; i < scan_->number_of_valid_detections; ++i) {
      const bool is_random = i >= detections_[id];
      scan_->range_m[i] = is_random ? range_m(random_) : 20.0F + static_cast<float>(i);
      scan_->range_rate_mps[i] = is_random ? range_rate_mps(random_) : -speed_mps_;
    }
  }
  ServiceStatus& status(Service service) { return status_[static_cast<std::size_t>(service)]; }
  const ServiceHealth& service(Service s) const { return report_->services[static_cast<std::size_t>(s)]; }
  const SensorHealth& radar(std::uint32_t id) const { return report_->sensors[id - 1]; }

  /// Lets time pass in steps of 10 ms: scans at 20 Hz, heartbeats at 10 Hz, estimates at 5 Hz, except muted ones;
  /// judged at 50 Hz as by the service.
  void run(double seconds) {
    const std::int64_t end_ns = now_ + static_cast<std::int64_t>(seconds * 1e9);
    for (; now_ < end_ns; now_ += 10 * kMillisecond, ++step_) {
      const bool scan_is_due = step_ % static_cast<std::uint64_t>(scan_every_) == 0;
      for (std::uint32_t id : {1u, 2u}) {
        if (!scan_is_due || silent_radar_ == id) continue;
        scan_->header.source_id = id;
        scan_->header.source_sequence = ++sequence_[id];
        scan_->header.measurement_time_ns = now_;
        fill(id);
        supervision_.observe(*scan_, now_);
        ++status_[0].sources[id - 1].messages;
        for (std::size_t s = 0; s < 5; ++s) {
          if (!idle_[s]) ++status_[s].outputs;
        }
        if (!idle_[static_cast<std::size_t>(Service::kTracker)]) supervision_.observe(*tracks_, now_);
      }
      if (step_ % 20 == 0) {
        for (auto& estimate : estimate_) {
          estimate.header.measurement_time_ns = now_;
          supervision_.observe(estimate);
        }
      }
      if (step_ % 10 == 0) {
        for (std::size_t s = 0; s < status_.size(); ++s) {
          if (!mute_[s]) supervision_.observe(status_[s], now_);
        }
      }
      if (step_ % 2 == 0) supervision_.judge(*report_, now_, kEpoch + now_);
    }
    supervision_.judge(*report_, now_, kEpoch + now_);
  }

  Supervision supervision_{two_radars(), Config{.set_s = 1.0, .clear_s = 1.0, .faults = {}}, kStart};
  std::array<ServiceStatus, catalogue::kNumberOfSupervisedServices> status_{};
  std::array<AlignmentEstimate, 2> estimate_{};
  std::array<bool, 6> mute_{};
  std::array<bool, 6> idle_{};
  std::array<std::uint64_t, 3> sequence_{};
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::array<std::uint32_t, 3> detections_{0, 40, 40};
  std::array<std::uint32_t, 3> interference_{};
  float speed_mps_ = 0.0F;
  std::mt19937 random_{1};
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  std::unique_ptr<HealthReport> report_ = std::make_unique<HealthReport>();
  std::uint32_t silent_radar_ = 0;
  int scan_every_ = 5;
  std::int64_t now_ = kStart;
  std::uint64_t step_ = 0;
};

}  // namespace boresight::health
