#include "services/alignment_estimator/core/planar/planar_start.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace boresight::alignment::planar {

namespace {

/// Number of final passes, which use the detections' own stds.
constexpr int kLastPasses = 3;
constexpr double kMinInlierRatio = 0.25;

}  // namespace

PlanarStart::PlanarStart(const PlanarConfig& config) : config_(config), columns_(kColumns * kCapacity) {}

void PlanarStart::clear() {
  number_of_scans_ = number_of_detections_ = 0;
  seconds_ = 0.0;
  has_elevation_ = true;
  passes_ = 0;
}

void PlanarStart::store(const ScanDetections& scan, const Setting& setting) {
  const std::size_t room = std::min(kMaxPerScan, kCapacity - number_of_detections_);
  const std::size_t usable = std::min(scan.count, kMaxDetections), count = std::min(usable, room);
  const std::array<const std::array<double, kMaxDetections>*, kColumns> from{
      &scan.azimuth_rad,     &scan.elevation_rad,     &scan.range_rate_mps,
      &scan.azimuth_std_rad, &scan.elevation_std_rad, &scan.range_rate_std_mps};
  for (std::size_t c = 0; c < kColumns; ++c) {
    double* const to = columns_.data() + c * kCapacity + number_of_detections_;
    // Evenly spread over the scan, because sensors may sort their detections.
    for (std::size_t i = 0; i < count; ++i) to[i] = (*from[c])[i * usable / count];
  }
  scans_[number_of_scans_++] = {number_of_detections_, count, setting.speed_mps, setting.yaw_rate_radps,
                                scan.ambiguity_mps};
  number_of_detections_ += count;
  has_elevation_ = has_elevation_ && scan.has_elevation;
}

PlanarStart::Verdict PlanarStart::add(const ScanDetections& scan, const Setting& setting, double elapsed_s,
                                      const Parameters& prior_mean) {
  if (passes_ == 0) {
    store(scan, setting);
    seconds_ += elapsed_s;
    const bool room = number_of_scans_ < kMaxScans && number_of_detections_ < kCapacity;
    if (room && (seconds_ < config_.start_seconds || number_of_detections_ < kMinDetections)) {
      return Verdict::kSearching;
    }
    if (number_of_detections_ < kMinDetections) {
      clear();
      return Verdict::kNothing;
    }
    at_ = prior_mean;
    scale_mps_ = config_.start_scale_mps;
  }
  const bool last = passes_ + kLastPasses >= config_.start_passes;
  pass(setting.nominal, prior_mean, last ? 0.0 : scale_mps_ * scale_mps_);
  scale_mps_ *= config_.start_shrink;
  if (++passes_ < config_.start_passes) return Verdict::kSearching;
  const bool found = at_.allFinite() && information_.allFinite() && inlier_ratio_ >= kMinInlierRatio;
  clear();
  return found ? Verdict::kFound : Verdict::kNothing;
}

void PlanarStart::pass(const MountingPose& nominal, const Parameters& prior_mean, double added_variance) {
  Judgement judgement;
  judgement.gate = config_.outlier_gate_sigma;
  judgement.added_variance = added_variance;
  Sums total;
  for (std::size_t n = 0; n < number_of_scans_; ++n) {
    const Scan& scan = scans_[n];
    const double* const first = columns_.data() + scan.first;
    const Rows rows{first,
                    first + kCapacity,
                    first + 2 * kCapacity,
                    first + 3 * kCapacity,
                    first + 4 * kCapacity,
                    first + 5 * kCapacity,
                    scan.count,
                    scan.ambiguity_mps};
    const Sums sums = sum_rows(rows, {nominal, scan.speed_mps, scan.yaw_rate_radps}, at_, judgement);
    total.information += sums.information;
    total.from_noise += sums.from_noise;
    total.score += sums.score;
    total.inliers += sums.inliers;
    total.stationary += sums.stationary;
    total.elevation += sums.elevation;
    total.elevation_square += sums.elevation_square;
    total.elevation_variance += sums.elevation_variance;
  }
  inlier_ratio_ = total.stationary / static_cast<double>(number_of_detections_);
  Support support;
  support.add(total, 0.0);
  support.renew(has_elevation_);
  information_ = support.information(total.information);
  // Errors of the yaw rate are not estimated here.
  information_.row(parameter::kYawRateError).setZero();
  information_.col(parameter::kYawRateError).setZero();
  Parameters prior = Parameters::Constant(1.0 / (config_.prior_angle_std_rad * config_.prior_angle_std_rad));
  prior(parameter::kSpeedScale) = 1.0 / (config_.prior_speed_scale_std * config_.prior_speed_scale_std);
  Square sum = information_;
  sum.diagonal() += prior;
  Parameters score = support.score(total.score) + prior.cwiseProduct(prior_mean - at_);
  score(parameter::kYawRateError) = 0.0;
  at_ += sum.ldlt().solve(score);
}

}  // namespace boresight::alignment::planar
