#include "services/alignment_estimator/core/planar/planar_filter.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/planar/solve.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"

namespace boresight::alignment::planar {

namespace {

constexpr std::size_t kMinDetections = 4;
constexpr double kMaxSpeed_mps = 120.0, kMaxYawRate_radps = 4.0;
constexpr double kMaxGap_s = 1.0, kSameInstant_s = 5e-4;
constexpr double kSpreadMemory_s = 60.0, kStatisticsMemory_s = 10.0;
/// A scan whose share of stationary detections is below this part of the usual one is not used; after the given number
/// of such scans the radar starts again.
constexpr double kStrangeShare = 0.4;
constexpr int kMaxStrangeScans = 60;
constexpr int kScansToRenewal = 16;
/// A scan is linearised again until the step changes by less than this share of a std, or up to the maximum.
constexpr int kMaxIterations = 3;
constexpr double kSmallStep = 0.02;
/// E[ψ′] and E[ψ²] of Gaussian residuals with Tukey's constant 5: start values.
constexpr double kGaussianSlope = 0.784, kGaussianSquare = 0.66;

Rows rows_of(const ScanDetections& scan) {
  return {scan.azimuth_rad.data(),
          scan.elevation_rad.data(),
          scan.range_rate_mps.data(),
          scan.azimuth_std_rad.data(),
          scan.elevation_std_rad.data(),
          scan.range_rate_std_mps.data(),
          std::min(scan.count, kMaxDetections),
          scan.ambiguity_mps};
}

}  // namespace

PlanarFilter::Radar::Radar(const RadarConfig& radar, const PlanarConfig& config)
    : nominal(radar.mounting_pose), cycle_time_s(radar.cycle_time_s), start(config) {}

PlanarFilter::PlanarFilter(const VehicleConfig& vehicle, const PlanarConfig& config)
    : config_(config), speed_std_mps_(vehicle.ego.speed_std_mps), yaw_rate_std_radps_(vehicle.ego.yaw_rate_std_radps) {
  const std::size_t count = std::min(vehicle.radars.size(), kMaxRadars);
  radars_.reserve(count);
  for (std::size_t r = 0; r < count; ++r) radars_.emplace_back(vehicle.radars[r], config);
  const Eigen::Index size = column_of(count);
  state_ = State::Zero(size);
  state_(kSpeedScaleColumn) = 1.0;
  covariance_ = Covariance::Zero(size, size);
  covariance_(kSpeedScaleColumn, kSpeedScaleColumn) = square(config.prior_speed_scale_std);
  covariance_.diagonal().tail(size - kShared).setConstant(square(config.prior_angle_std_rad));
}

void PlanarFilter::set_variance(Eigen::Index column, double variance) {
  covariance_.row(column).setZero();
  covariance_.col(column).setZero();
  covariance_(column, column) = variance;
}

void PlanarFilter::advance(std::int64_t time_ns, const EgoSample& ego) {
  const double elapsed_s = has_instant_ ? seconds(time_ns - instant_ns_) : kMaxGap_s;
  if (std::abs(elapsed_s) < kSameInstant_s) return;
  state_(kSpeedColumn) = state_(kYawRateColumn) = 0.0;
  set_variance(kSpeedColumn, square(ego.speed_std_mps > 0.0 ? ego.speed_std_mps : speed_std_mps_));
  set_variance(kYawRateColumn, square(ego.yaw_rate_std_radps > 0.0 ? ego.yaw_rate_std_radps : yaw_rate_std_radps_));
  // The mounting of a parked car does not drift with time: a gap counts as kMaxGap_s at most.
  const double drift_s = std::clamp(elapsed_s, 0.0, kMaxGap_s);
  covariance_(kSpeedScaleColumn, kSpeedScaleColumn) += square(config_.speed_scale_drift_per_sqrt_s) * drift_s;
  covariance_.diagonal().tail(covariance_.rows() - kShared).array() +=
      square(config_.angle_drift_rad_per_sqrt_s) * drift_s;
  instant_ns_ = time_ns;
  has_instant_ = true;
}

Parameters PlanarFilter::local(std::size_t radar, double speed_mps) const {
  Parameters at;
  at << state_(kSpeedScaleColumn) * (1.0 - state_(kSpeedColumn) / speed_mps), state_(kYawRateColumn),
      state_.segment<3>(column_of(radar));
  return at;
}

PlanarFilter::Gain PlanarFilter::gain_columns(std::size_t radar, double speed_mps) const {
  Gain columns(covariance_.rows(), 5);
  columns.col(parameter::kSpeedScale) =
      covariance_.col(kSpeedScaleColumn) - state_(kSpeedScaleColumn) / speed_mps * covariance_.col(kSpeedColumn);
  columns.col(parameter::kYawRateError) = covariance_.col(kYawRateColumn);
  columns.rightCols<3>() = covariance_.middleCols<3>(column_of(radar));
  return columns;
}

Square PlanarFilter::local_covariance(const Gain& columns, std::size_t radar, double speed_mps) const {
  Square out;
  out.row(parameter::kSpeedScale) =
      columns.row(kSpeedScaleColumn) - state_(kSpeedScaleColumn) / speed_mps * columns.row(kSpeedColumn);
  out.row(parameter::kYawRateError) = columns.row(kYawRateColumn);
  out.bottomRows<3>() = columns.middleRows<3>(column_of(radar));
  return out;
}

void PlanarFilter::process(std::size_t index, const ScanDetections& scan, const EgoSample& ego) {
  if (index >= radars_.size()) return;
  Radar& radar = radars_[index];
  const double since_s = radar.last_time_ns == 0 ? 0.0 : seconds(scan.time_ns - radar.last_time_ns);
  const double elapsed_s = since_s > 0.0 && since_s < kMaxGap_s ? since_s : radar.cycle_time_s;
  radar.last_time_ns = scan.time_ns;
  const bool usable = ego.valid && !ego.stale && ego.speed_mps >= config_.min_speed_mps &&
                      ego.speed_mps < kMaxSpeed_mps && std::abs(ego.yaw_rate_radps) < kMaxYawRate_radps;
  if (!usable || scan.count < kMinDetections) {
    radar.state = std::max(radar.state, AlignmentState::kWaiting);
    return;
  }
  advance(scan.time_ns, ego);
  const Setting setting{radar.nominal, ego.speed_mps, ego.yaw_rate_radps};
  if (radar.running) {
    update(index, scan, setting, elapsed_s);
  } else {
    search(index, scan, setting, elapsed_s);
  }
  if (!radar.running) {
    radar.state = std::max(radar.state, AlignmentState::kWaiting);
    return;
  }
  radar.seconds_of_drive += elapsed_s;
  const double yaw_variance = covariance_(column_of(index), column_of(index));
  const bool sure =
      yaw_variance < square(config_.converged_yaw_std_rad) && radar.seconds_of_drive >= config_.min_seconds_to_converge;
  radar.state = sure ? AlignmentState::kConverged : AlignmentState::kConverging;
}

void PlanarFilter::search(std::size_t index, const ScanDetections& scan, const Setting& setting, double elapsed_s) {
  Radar& radar = radars_[index];
  Parameters prior = Parameters::Zero();
  prior(parameter::kSpeedScale) = state_(kSpeedScaleColumn);
  if (radar.start.add(scan, setting, elapsed_s, prior) != PlanarStart::Verdict::kFound) return;
  // The start counts as one measurement with a linear model around the result.
  const Square information = radar.start.information() / config_.start_inflation;
  Parameters at = local(index, setting.speed_mps);
  at(parameter::kSpeedScale) = state_(kSpeedScaleColumn);
  take(index, setting.speed_mps, information, information * (radar.start.parameters() - at));
  radar.running = true;
  radar.inlier_ratio = radar.start.inlier_ratio();
  radar.slope = kGaussianSlope;
  radar.square = kGaussianSquare;
  radar.strange_scans = radar.scans_to_renewal = 0;
}

void PlanarFilter::update(std::size_t index, const ScanDetections& scan, const Setting& setting, double elapsed_s) {
  Radar& radar = radars_[index];
  const Rows rows = rows_of(scan);
  const Parameters before = local(index, setting.speed_mps);
  const Square covariance = local_covariance(gain_columns(index, setting.speed_mps), index, setting.speed_mps);
  Judgement judgement;
  judgement.gate = config_.outlier_gate_sigma;
  judgement.covariance = covariance;
  // Smallest variance with Tukey's weights: with the gain 1/E[ψ′] it is E[ψ²]/E[ψ′]² times the variance without
  // outliers.
  const double of_score = radar.slope / radar.square, of_information = of_score * radar.slope;
  Parameters at = before, score = Parameters::Zero();
  Square information = Square::Zero();
  for (int i = 0; i < kMaxIterations; ++i) {
    const Sums sums = sum_rows(rows, setting, at, judgement);
    if (i == 0) {
      const double share = sums.stationary / static_cast<double>(rows.count);
      if (share < kStrangeShare * radar.inlier_ratio) {
        if (++radar.strange_scans > kMaxStrangeScans) reopen(index);
        return;
      }
      radar.strange_scans = 0;
      const double step = 1.0 - std::exp(-elapsed_s / kStatisticsMemory_s);
      radar.inlier_ratio += (share - radar.inlier_ratio) * step;
      radar.slope = std::clamp(radar.slope + (sums.slope / sums.inliers - radar.slope) * step, 0.2, 1.0);
      radar.square = std::clamp(radar.square + (sums.square / sums.inliers - radar.square) * step, 0.1, 4.0);
      radar.support.add(sums, std::exp(-elapsed_s / kSpreadMemory_s));
      if (radar.scans_to_renewal-- <= 0) {
        radar.support.renew(scan.has_elevation);
        radar.scans_to_renewal = kScansToRenewal;
      }
      ++radar.scans_used;
      radar.detections_used += static_cast<std::uint64_t>(sums.inliers);
    }
    information = of_information * radar.support.information(sums.information);
    score = of_score * radar.support.score(sums.score) + information * (at - before);
    // The step of this linearisation, for the parameters that the scan depends on.
    const Square system = Square::Identity() + covariance * information;
    const Parameters step = solve(system, covariance * score);
    const Parameters moved = before + step - at;
    at = before + step;
    if (!at.allFinite()) return;
    if ((moved.cwiseAbs2().array() <= square(kSmallStep) * covariance.diagonal().array()).all()) break;
  }
  radar.has_elevation = radar.support.has_elevation();
  take(index, setting.speed_mps, information, score);
}

void PlanarFilter::take(std::size_t index, double speed_mps, const Square& information, const Parameters& score) {
  const Gain columns = gain_columns(index, speed_mps);
  const Square covariance = local_covariance(columns, index, speed_mps);
  // W = (Λ⁻¹ + C)⁻¹, also where Λ is singular: P ← P − P_c·W·P_cᵀ, x ← x + P_c·(1 − W·C)·score.
  const Square system = Square::Identity() + covariance * information;
  Square w = solve_columns(system.transpose(), information);
  w = 0.5 * (w + w.transpose()).eval();
  const Parameters step = score - w * (covariance * score);
  if (!w.allFinite() || !step.allFinite()) return;
  state_ += columns * step;
  const Gain product = columns * w;
  covariance_.noalias() -= product * columns.transpose();
  for (Eigen::Index i = 0; i < covariance_.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      covariance_(i, j) = covariance_(j, i) = 0.5 * (covariance_(i, j) + covariance_(j, i));
    }
  }
}

void PlanarFilter::reopen(std::size_t index) {
  Radar& radar = radars_[index];
  radar.running = false;
  radar.start.clear();
  radar.support = {};
  for (Eigen::Index i = 0; i < 3; ++i) {
    state_(column_of(index) + i) = 0.0;
    set_variance(column_of(index) + i, square(config_.prior_angle_std_rad));
  }
}

}  // namespace boresight::alignment::planar
