#include "services/health/dds/alignment.hpp"

#include "services/common/alignment_words/alignment_words.hpp"
#include "services/health/dds/enumeration.hpp"

namespace boresight::dds {

namespace {

// A new layout of the message needs a look at the IDL.
static_assert(AlignmentEstimate::kVersion == 4 && sizeof(AlignmentEstimate) == 656);
static_assert(static_cast<int>(AlignmentState::kConverged) == diagnostics::ALIGNMENT_CONVERGED);
static_assert(static_cast<int>(AlignmentReason::kShortDrive) == diagnostics::REASON_SHORT_DRIVE);
static_assert(static_cast<int>(AlignmentFinding::kCopiedDetections) == diagnostics::FINDING_COPIED_DETECTIONS);

diagnostics::EstimatedValue to_value(const AlignmentValue& value) {
  diagnostics::EstimatedValue out;
  out.value(value.value);
  out.std(value.std);
  return out;
}

void fill_nuisance(diagnostics::NuisanceParameters& out, const AlignmentNuisance& nuisance) {
  out.range_rate_scale(to_value(nuisance.range_rate_scale));
  out.time_offset_s(to_value(nuisance.time_offset_s));
  out.position_x_m(to_value(nuisance.position_x_m));
  out.position_y_m(to_value(nuisance.position_y_m));
  out.yaw_rate_gain(to_value(nuisance.yaw_rate_gain));
  out.pitch_per_acceleration_radps2pm(to_value(nuisance.pitch_per_acceleration_radps2pm));
  out.load_pitch_rad(to_value(nuisance.load_pitch_rad));
  out.yaw_scatter_rad(nuisance.yaw_scatter_rad);
  out.pitch_scatter_rad(nuisance.pitch_scatter_rad);
  out.azimuth_curve_rad(nuisance.azimuth_curve_rad);
  out.azimuth_curve_std_rad(nuisance.azimuth_curve_std_rad);
  out.azimuth_curve_first_rad(nuisance.azimuth_curve_first_rad);
  out.azimuth_curve_step_rad(nuisance.azimuth_curve_step_rad);
  out.observable(nuisance.observable);
  out.range_rate_noise_scale(nuisance.range_rate_noise_scale);
}

void fill_kpis(diagnostics::AlignmentKpis& out, const AlignmentKpis& kpis) {
  out.residual_rmse_mps(kpis.residual_rmse_mps);
  out.uncorrected_residual_rmse_mps(kpis.uncorrected_residual_rmse_mps);
  out.residual_skewness(kpis.residual_skewness);
  out.residual_kurtosis(kpis.residual_kurtosis);
  out.inlier_ratio(kpis.inlier_ratio);
  out.seconds_of_drive(kpis.seconds_of_drive);
  out.seconds_to_95_percent(kpis.seconds_to_95_percent);
  out.scans_to_95_percent(kpis.scans_to_95_percent);
  out.drift_per_minute(kpis.drift_per_minute);
  out.nees(kpis.nees);
  out.scans_used(kpis.scans_used);
  out.detections_used(kpis.detections_used);
}

}  // namespace

diagnostics::MountingDrift to_drift(const AlignmentDrift& drift) {
  diagnostics::MountingDrift out;
  out.since_ns(drift.since_ns);
  out.yaw_radps(drift.yaw_radps);
  out.yaw_std_radps(drift.yaw_std_radps);
  out.pitch_radps(drift.pitch_radps);
  out.pitch_std_radps(drift.pitch_std_radps);
  return out;
}

diagnostics::VehicleChange to_change(const AlignmentVehicleChange& change) {
  diagnostics::VehicleChange out;
  out.time_ns(change.time_ns);
  out.size(change.size);
  out.count(change.count);
  return out;
}

void fill(diagnostics::AlignmentEstimate& out, const AlignmentEstimate& estimate, const VehicleConfig& vehicle,
          std::int64_t time_ns) {
  out.radar_id(estimate.header.source_id);
  out.radar_name(alignment_words::radar_name(vehicle, estimate.header.source_id));
  out.vehicle_name(vehicle.name);
  out.time_ns(time_ns);
  out.measurement_time_ns(estimate.header.measurement_time_ns);
  out.layout_version(estimate.header.version);
  out.sequence_number(estimate.header.sequence);
  out.radar_sequence_number(estimate.header.source_sequence);
  out.state(enumerator(estimate.state, diagnostics::ALIGNMENT_CONVERGED));
  out.reason(enumerator(estimate.reason, diagnostics::REASON_SHORT_DRIVE));
  out.finding(enumerator(estimate.finding, diagnostics::FINDING_COPIED_DETECTIONS));
  out.finding_value(estimate.finding_value);
  out.finding_radar(estimate.finding_radar);
  out.observable(estimate.observable);
  out.speed_scale(estimate.speed_scale);
  out.alignment_yaw_rad(estimate.alignment_yaw_rad);
  out.alignment_pitch_rad(estimate.alignment_pitch_rad);
  out.alignment_roll_rad(estimate.alignment_roll_rad);
  out.vehicle_yaw_rad(estimate.vehicle_yaw_rad);
  out.vehicle_pitch_rad(estimate.vehicle_pitch_rad);
  out.vehicle_roll_rad(estimate.vehicle_roll_rad);
  out.yaw_rate_bias_radps(estimate.yaw_rate_bias_radps);
  out.yaw_rate_bias_std_radps(estimate.yaw_rate_bias_std_radps);
  out.slip_coefficient_radps2pm(estimate.slip_coefficient_radps2pm);
  out.slip_coefficient_std_radps2pm(estimate.slip_coefficient_std_radps2pm);
  out.angle_noise_scale(estimate.angle_noise_scale);
  out.covariance(estimate.covariance);
  out.vehicle_covariance(estimate.vehicle_covariance);
  out.step_change().time_ns(estimate.step_change.time_ns);
  out.step_change().rotation_vehicle_rad(estimate.step_change.rotation_vehicle_rad);
  out.step_change().count(estimate.step_change.count);
  out.load_change(to_change(estimate.load_change));
  out.speed_change(to_change(estimate.speed_change));
  out.drift(to_drift(estimate.drift));
  fill_nuisance(out.nuisance(), estimate.nuisance);
  fill_kpis(out.kpis(), estimate.kpis);
}

}  // namespace boresight::dds
