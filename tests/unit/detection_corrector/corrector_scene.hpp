// A radar's scans, ego motion and alignment estimates for the corrector.
#pragma once

#include <cstring>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/detection_corrector/core/corrector.hpp"

namespace boresight::corrector {

inline constexpr std::int64_t kTime = 1'000'000'000'000;

inline VehicleConfig one_radar(double yaw_deg = 0.0, double pitch_deg = 0.0, double roll_deg = 0.0) {
  VehicleConfig vehicle;
  RadarConfig radar;
  radar.id = 2;
  radar.mounting_pose = {
      {3.6, -0.7, 0.5}, yaw_deg * kRadiansPerDegree, pitch_deg * kRadiansPerDegree, roll_deg * kRadiansPerDegree};
  radar.noise = {.range_std_m = 0.1,
                 .azimuth_std_rad = 0.2 * kRadiansPerDegree,
                 .elevation_std_rad = 0.3 * kRadiansPerDegree,
                 .range_rate_std_mps = 0.03};
  vehicle.radars.push_back(radar);
  return vehicle;
}

inline EgoMotion ego(float speed, float yaw_rate, std::int64_t time_ns = kTime) {
  EgoMotion m{};
  m.header.measurement_time_ns = time_ns;
  m.fields = ego_field::kSpeed | ego_field::kYawRate;
  m.speed_mps = speed;
  m.speed_std_mps = 0.03F;
  m.yaw_rate_radps = yaw_rate;
  m.yaw_rate_std_radps = 0.002F;
  return m;
}

inline AlignmentEstimate yaw_estimate(double yaw_rad, double scale) {
  AlignmentEstimate e{};
  e.header.source_id = 2;
  e.header.sequence = 77;
  e.header.measurement_time_ns = kTime;
  e.state = AlignmentState::kConverged;
  e.observable = alignment_axis::kYaw | alignment_axis::kVehicleYaw | alignment_axis::kSpeedScale;
  e.alignment_yaw_rad = e.vehicle_yaw_rad = static_cast<float>(yaw_rad);
  e.alignment_pitch_rad = e.vehicle_pitch_rad = 0.5F;  // not observable: must not be applied
  e.speed_scale = static_cast<float>(scale);
  e.covariance[0] = 1e-6F;
  e.covariance[5] = 1e-7F;
  e.covariance[10] = e.covariance[15] = 0.005F;
  e.vehicle_covariance = e.covariance;
  return e;
}

class CorrectorTest : public testing::Test {
 protected:
  CorrectorTest() {
    std::memset(static_cast<void*>(out_.get()), 0xCD, sizeof(CorrectedScan));  // a chunk holds stale data
    scan_->header = {};
    scan_->header.source_id = 2;
    scan_->header.measurement_time_ns = kTime;
    scan_->fields = scan_field::kElevation | scan_field::kRcs;
    scan_->number_of_valid_detections = 0;
  }
  void add(double range, double azimuth, double elevation, double range_rate, double rcs = 10.0) {
    const std::uint32_t i = scan_->number_of_valid_detections++;
    scan_->range_m[i] = static_cast<float>(range);
    scan_->azimuth_rad[i] = static_cast<float>(azimuth);
    scan_->elevation_rad[i] = static_cast<float>(elevation);
    scan_->range_rate_mps[i] = static_cast<float>(range_rate);
    scan_->rcs_dbsm[i] = static_cast<float>(rcs);
    scan_->snr_db[i] = 20.0F;
    scan_->detection_flags[i] = 0;
  }
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::unique_ptr<CorrectedScan> out_ = std::make_unique<CorrectedScan>();
};

}  // namespace boresight::corrector
