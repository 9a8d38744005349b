#include "services/boresight/align/residuals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::align {

namespace {

constexpr double kGate_sigma = 4.0;

}  // namespace

Moments moments(const std::vector<double>& residuals) {
  if (residuals.empty()) return {kNaN, kNaN, kNaN};
  const auto n = static_cast<double>(residuals.size());
  double mean = 0.0, square = 0.0;
  for (const double r : residuals) {
    mean += r / n;
    square += r * r / n;
  }
  double m2 = 0.0, m3 = 0.0, m4 = 0.0;
  for (const double r : residuals) {
    const double d = r - mean;
    m2 += d * d / n;
    m3 += d * d * d / n;
    m4 += d * d * d * d / n;
  }
  if (m2 < 1e-18) return {std::sqrt(square), kNaN, kNaN};
  return {std::sqrt(square), m3 / std::pow(m2, 1.5), m4 / (m2 * m2)};
}

void ResidualSample::halve() {
  std::size_t kept_scans = 0, kept_detections = 0;
  for (std::size_t i = 0; i < scans_.size(); i += 2) {
    Scan scan = scans_[i];
    std::copy_n(detections_.begin() + static_cast<std::ptrdiff_t>(scan.first), scan.count,
                detections_.begin() + static_cast<std::ptrdiff_t>(kept_detections));
    scan.first = kept_detections;
    kept_detections += scan.count;
    scans_[kept_scans++] = scan;
  }
  scans_.resize(kept_scans);
  detections_.resize(kept_detections);
  stride_ *= 2;
}

void ResidualSample::add(const alignment::ScanDetections& scan, const EgoSample& ego) {
  if (count_++ % stride_ != 0) return;
  if (detections_.size() + scan.count > kMostDetections) {
    halve();
    if ((count_ - 1) % stride_ != 0) return;
  }
  scans_.push_back({static_cast<float>(ego.speed_mps), static_cast<float>(ego.yaw_rate_radps),
                    static_cast<float>(scan.ambiguity_mps), detections_.size(), scan.count});
  for (std::size_t i = 0; i < scan.count; ++i) {
    detections_.push_back({static_cast<float>(scan.azimuth_rad[i]), static_cast<float>(scan.elevation_rad[i]),
                           static_cast<float>(scan.range_rate_mps[i]), static_cast<float>(scan.azimuth_std_rad[i]),
                           static_cast<float>(scan.elevation_std_rad[i]),
                           static_cast<float>(scan.range_rate_std_mps[i])});
  }
}

alignment::batch_calibration::Recording ResidualSample::recording(const MountingPose& nominal,
                                                                  bool has_elevation) const {
  alignment::batch_calibration::Recording recording;
  recording.nominal = nominal;
  recording.has_elevation = has_elevation;
  recording.detections.reserve(detections_.size());
  for (const Scan& scan : scans_) {
    for (std::size_t i = scan.first; i < scan.first + scan.count; ++i) {
      const Detection& d = detections_[i];
      recording.detections.push_back(
          {d.azimuth_rad, d.elevation_rad, d.range_rate_mps, scan.speed_mps, scan.yaw_rate_radps});
    }
  }
  return recording;
}

ResidualSummary ResidualSample::judge(const alignment::RadarEstimate& estimate, const RadarConfig& radar,
                                      const Eigen::Matrix3d& nominal) const {
  std::vector<double> before, after;       // of inliers
  std::vector<std::array<double, 2>> all;  // before, after
  all.reserve(detections_.size());
  const double angle_scale = std::max(1.0, estimate.angle_noise_scale);
  for (const Scan& scan : scans_) {
    const double speed = scan.speed_mps, yaw_rate = scan.yaw_rate_radps;
    const Eigen::Vector3d signalled = geometry::sensor_velocity(1.0, speed, yaw_rate, radar.mounting_pose.position_m);
    const double true_speed = estimate.speed_scale * speed, true_yaw_rate = yaw_rate - estimate.yaw_rate_bias_radps;
    const Eigen::Vector3d velocity =
        geometry::sensor_velocity(1.0, true_speed, true_yaw_rate, radar.mounting_pose.position_m,
                                  -estimate.slip_coefficient_radps2pm * true_speed * true_speed * true_yaw_rate);
    // In sensor axes once, so that each detection is one direction.
    const Eigen::Vector3d nominal_velocity = nominal.transpose() * signalled;
    const Eigen::Vector3d sensor_velocity = estimate.sensor_to_vehicle.transpose() * velocity;
    for (std::size_t i = scan.first; i < scan.first + scan.count; ++i) {
      const Detection& d = detections_[i];
      const double ca = std::cos(d.azimuth_rad), sa = std::sin(d.azimuth_rad);
      const double ce = std::cos(d.elevation_rad), se = std::sin(d.elevation_rad);
      const Eigen::Vector3d direction(ce * ca, ce * sa, se);
      const auto unfold = [&](double residual) {
        return scan.ambiguity_mps > 0.0F ? std::remainder(residual, static_cast<double>(scan.ambiguity_mps)) : residual;
      };
      const double r0 = unfold(d.range_rate_mps + direction.dot(nominal_velocity));
      const double r1 = unfold(d.range_rate_mps + direction.dot(sensor_velocity));
      const double by_azimuth =
          ce * (sensor_velocity.y() * ca - sensor_velocity.x() * sa) * angle_scale * d.azimuth_std_rad;
      const double by_elevation =
          (ce * sensor_velocity.z() - se * (ca * sensor_velocity.x() + sa * sensor_velocity.y())) * angle_scale *
          d.elevation_std_rad;
      const double std = std::sqrt(d.range_rate_std_mps * d.range_rate_std_mps + by_azimuth * by_azimuth +
                                   by_elevation * by_elevation);
      all.push_back({r0, r1});
      if (std::abs(r1) > kGate_sigma * std) continue;
      before.push_back(r0);
      after.push_back(r1);
    }
  }
  ResidualSummary result;
  result.before = moments(before);
  result.after = moments(after);
  result.judged = all.size();
  result.inlier_ratio = all.empty() ? kNaN : static_cast<double>(after.size()) / static_cast<double>(all.size());
  constexpr double kStdsShown = 4.0;
  const double widest =
      std::max(after.empty() ? 0.0 : result.after.rmse_mps, before.empty() ? 0.0 : result.before.rmse_mps);
  result.histogram.limit_mps = widest > 0.0 ? kStdsShown * widest : 1.0;
  for (const auto& [r0, r1] : all) {
    const auto bin = [&](double r) {
      return static_cast<std::size_t>((r / result.histogram.limit_mps + 1.0) * 0.5 * Histogram::kBins);
    };
    if (std::abs(r0) < result.histogram.limit_mps) ++result.histogram.before.at(bin(r0));
    if (std::abs(r1) < result.histogram.limit_mps) ++result.histogram.after.at(bin(r1));
  }
  return result;
}

}  // namespace boresight::align
