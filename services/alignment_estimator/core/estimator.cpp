#include "services/alignment_estimator/core/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/alignment_estimator/core/kpi/count_residuals.hpp"
#include "services/alignment_estimator/core/kpi/nees.hpp"
#include "services/alignment_estimator/core/make_method.hpp"
#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/common/estimation/scan_trust.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

/// True R(sensor→vehicle); none if the truth file lacks the radar or one of its angles.
std::optional<Eigen::Matrix3d> actual_mounting(const RadarConfig& radar, const std::optional<DriveTruth>& truth) {
  if (!truth) return std::nullopt;
  const auto found = truth->radars.find(radar.id);
  if (found == truth->radars.end()) return std::nullopt;
  const DriveTruth::Radar& t = found->second;
  if (!std::isfinite(t.yaw_rad + t.pitch_rad + t.roll_rad)) return std::nullopt;
  return geometry::sensor_to_vehicle(radar.mounting_pose, t.yaw_rad, t.pitch_rad, t.roll_rad);
}

}  // namespace

Estimator::Estimator(const VehicleConfig& vehicle, const Config& config)
    : config_(config), method_(make_method(vehicle, config)), plausibility_(vehicle, config.plausibility) {
  radars_.resize(vehicle.radars.size());
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    radars_[i].config = vehicle.radars[i];
    radars_[i].actual = actual_mounting(vehicle.radars[i], config.truth);
  }
}

ScanResult Estimator::add_scan(const RadarScan& scan) {
  const auto radar = std::find_if(radars_.begin(), radars_.end(),
                                  [&](const Radar& r) { return r.config.id == scan.header.source_id; });
  if (radar == radars_.end()) return ScanResult::kUnknownRadar;
  const std::int64_t time_ns = scan.header.measurement_time_ns;
  const EgoSample ego = ego_.at(time_ns);
  const bool moves = ego.valid && !ego.stale;
  const auto index = static_cast<std::size_t>(radar - radars_.begin());
  if (!radar->seen) begin(index);
  take_detections(scan, radar->config, detections_);
  plausibility_.add(index, detections_, ego);
  // A scan that is proven wrong tells nothing of the mounting. What is wrong with it is for the search for wrong
  // inputs.
  if (moves && !is_scan_wrong(scan)) offer(index, ego);
  const auto period_ns = static_cast<std::int64_t>(config_.publish_period_s * 1e9);
  // By the measurement clock, so that a replay publishes the same estimates at any speed. If the clock went back, the
  // estimate is published at once.
  if (time_ns >= radar->next_publish_ns || time_ns < radar->next_publish_ns - 2 * period_ns) {
    radar->next_publish_ns = time_ns + period_ns;
    return ScanResult::kPublish;
  }
  return moves ? ScanResult::kUsed : ScanResult::kNoEgoMotion;
}

void Estimator::add_rejected_scan(const RadarScan& scan) {
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    if (radars_[i].config.id != scan.header.source_id) continue;
    if (!radars_[i].seen) begin(i);
    take_detections(scan, radars_[i].config, detections_);
    plausibility_.add_rejected(i, detections_);
  }
}

void Estimator::begin(std::size_t index) {
  Radar& radar = radars_[index];
  const RadarEstimate e = method_->estimate(index);
  radar.seen = true;
  radar.scans_used = e.scans_used;
  // Start of the distance to the estimate: the nominal mounting or the restored memory.
  radar.convergence.add(0.0, 0, vehicle_form(radar.config, e).values, e.step_change.count);
}

void Estimator::offer(std::size_t index, const EgoSample& ego) {
  Radar& radar = radars_[index];
  method_->process(index, detections_, ego);
  const double since_s =
      radar.last_time_ns == 0 ? 0.0 : static_cast<double>(detections_.time_ns - radar.last_time_ns) * 1e-9;
  radar.last_time_ns = detections_.time_ns;
  if (std::abs(ego.speed_mps) < config_.min_speed_mps() || detections_.count == 0) return;
  // A restarted recording, or a pause, does not count as driving.
  const double elapsed_s = since_s > 0.0 && since_s < 1.0 ? since_s : radar.config.cycle_time_s;
  radar.drive_s += elapsed_s;
  ++radar.drive_scans;
  observe(index, ego, elapsed_s);
}

void Estimator::observe(std::size_t index, const EgoSample& ego, double elapsed_s) {
  Radar& radar = radars_[index];
  const RadarEstimate e = method_->estimate(index);
  radar.convergence.add(radar.drive_s, radar.drive_scans, vehicle_form(radar.config, e).values, e.step_change.count);
  // A scan that the method did not use does not count in the key figures.
  if (e.scans_used == radar.scans_used) return;
  radar.scans_used = e.scans_used;
  radar.residuals.fade(elapsed_s, config_.kpi_window_s);
  const std::span<double> predicted(predicted_.data(), detections_.count);
  method_->predict(index, detections_, ego, predicted);
  count_residuals(radar.config, e, detections_, ego, predicted, config_.residual_gate_sigma, radar.residuals);
}

RadarEstimate Estimator::estimate(std::size_t radar) const {
  RadarEstimate e = method_->estimate(radar);
  // Methods do not receive scans without ego motion.
  if (radars_[radar].seen) e.state = std::max(e.state, AlignmentState::kWaiting);
  if (plausibility_.finding(radar).finding != AlignmentFinding::kNone) {
    e.state = std::min(e.state, AlignmentState::kConverging);
    e.reason = AlignmentReason::kWrongInput;
  }
  return e;
}

bool Estimator::write(std::uint32_t radar_id, AlignmentEstimate& out) const {
  const auto found =
      std::find_if(radars_.begin(), radars_.end(), [&](const Radar& r) { return r.config.id == radar_id; });
  if (found == radars_.end()) return false;
  const auto index = static_cast<std::size_t>(found - radars_.begin());
  const RadarEstimate e = estimate(index);
  write_estimate(found->config, e, config_.prior_angle_std_rad(), out);
  const plausibility::Finding finding = plausibility_.finding(index);
  out.finding = finding.finding;
  out.finding_value = static_cast<float>(finding.value);
  out.finding_radar = finding.radar;
  AlignmentKpis& kpis = out.kpis;
  found->residuals.write(kpis);
  kpis.seconds_of_drive = static_cast<float>(e.seconds_of_drive);
  kpis.scans_used = e.scans_used;
  kpis.detections_used = e.detections_used;
  kpis.reserved = 0;
  constexpr std::array<std::uint32_t, 4> kAxes{alignment_axis::kSpeedScale, alignment_axis::kVehicleYaw,
                                               alignment_axis::kVehiclePitch, alignment_axis::kVehicleRoll};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    const auto parameter = static_cast<AlignmentParameter>(i);
    const double std = out.is_observable(kAxes[i]) ? std::sqrt(static_cast<double>(out.vehicle_covariance[5 * i]))
                                                   : std::numeric_limits<double>::infinity();
    const Convergence::Settled settled = found->convergence.to_95_percent(parameter, std);
    kpis.seconds_to_95_percent[i] = static_cast<float>(settled.seconds);
    kpis.scans_to_95_percent[i] = settled.scans;
    kpis.drift_per_minute[i] = static_cast<float>(found->convergence.drift_per_minute(parameter));
  }
  kpis.nees = found->actual ? static_cast<float>(nees(e, config_.truth->speed_scale, *found->actual))
                            : std::numeric_limits<float>::quiet_NaN();
  return true;
}

bool Estimator::seed(const RotationSeed& seed) {
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    if (radars_[i].config.id != seed.radar_id) continue;
    return method_->seed(i, seed.rotation_vehicle_rad, seed.covariance);
  }
  return false;
}

Memory Estimator::memory() const {
  Memory memory;
  method_->save(memory);
  return memory;
}

}  // namespace boresight::alignment
