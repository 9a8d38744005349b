#include "services/simulator/alignment/truth_text.hpp"

#include <cmath>

#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/car/truth.hpp"

namespace boresight::simulator {

namespace {

std::string angles_text(const Eigen::Vector3d& yaw_pitch_roll_rad) {
  const Eigen::Vector3d degrees = yaw_pitch_roll_rad / kRadiansPerDegree;
  return fmt::format("alpha_deg {:.4f} beta_deg {:.4f} gamma_deg {:.4f}", degrees.x(), degrees.y(), degrees.z());
}

/// α, β, γ of a mounting: true angles minus nominal angles.
Eigen::Vector3d misalignment(const Eigen::Matrix3d& rotation, const MountingPose& nominal) {
  Eigen::Vector3d angles = geometry::euler_angles(rotation);
  angles -= Eigen::Vector3d(nominal.yaw_rad, nominal.pitch_rad, nominal.roll_rad);
  for (double& angle : angles) angle = geometry::wrap_angle(angle);
  return angles;
}

std::string radar_text(const AlignmentRadar& radar) {
  const MountingPose& pose = radar.config.mounting_pose;
  return fmt::format("radar {} mount_az_deg {:.4g} x {:.2f} y {:.2f} {} mount_pitch_deg {:.4g} mount_roll_deg {:.4g}\n",
                     radar.config.id, pose.yaw_rad / kRadiansPerDegree, pose.position_m[0], pose.position_m[1],
                     angles_text({radar.truth.yaw_rad, radar.truth.pitch_rad, radar.truth.roll_rad}),
                     pose.pitch_rad / kRadiansPerDegree, pose.roll_rad / kRadiansPerDegree);
}

std::string step_change_text(const StepChange& step_change, const AlignmentSpec& spec, const AlignmentDrive& drive) {
  const RadarConfig& radar = spec.radars[step_change.radar].config;
  const Eigen::Vector3d turn = step_change.rotation_vehicle_rad / kRadiansPerDegree;
  return fmt::format(
      "step_change t {:.4f} radar {} turn_x_deg {:.4f} turn_y_deg {:.4f} turn_z_deg {:.4f} {}\n",
      step_change.time_s - AlignmentDrive::kStart_s, radar.id, turn.x(), turn.y(), turn.z(),
      angles_text(misalignment(drive.sensor_to_vehicle(step_change.radar, step_change.time_s), radar.mounting_pose)));
}

/// The real car's effects, one a line; none if all are off.
std::string real_car_text(const AlignmentSpec& spec) {
  std::string text;
  for (const car::TruthRow& row : car::truth_of_car(spec.real_car)) {
    text += fmt::format("real_car {} {:.8f} {}\n", row.quantity, row.value, row.unit);
  }
  for (const AlignmentRadar& radar : spec.radars) {
    const RadarConfig& config = radar.config;
    const car::RadarOfCar of_car = car::radar_of_car(spec.real_car, spec.seed, config.id, config.field_of_view);
    for (const car::TruthRow& row : car::truth_of_radar(spec.real_car, of_car, config.id)) {
      text += fmt::format("real_car {} {:.8f} {} radar {}\n", row.quantity, row.value, row.unit, config.id);
    }
  }
  return text;
}

std::string bound_text(const CramerRaoBound& bound, std::size_t radars) {
  std::string text = fmt::format("crlb_sd kv {:.3g} | vehicle-frame roll/pitch/yaw deg per radar (3 deg prior): [",
                                 bound.speed_scale_std());
  for (std::size_t i = 0; i < radars; ++i) {
    const Eigen::Vector3d std = bound.rotation_std_rad(i) / kRadiansPerDegree;
    text += fmt::format("{}[{:.4f}, {:.4f}, {:.4f}]", i > 0 ? ", " : "", std.x(), std.y(), std.z());
  }
  return text + "]\n";
}

}  // namespace

std::string truth_text(const AlignmentSpec& spec, const AlignmentDrive& drive, const AlignmentResiduals& residuals,
                       const CramerRaoBound* bound) {
  const AlignmentRadar first = spec.radars.empty() ? AlignmentRadar{} : spec.radars.front();
  const SensorNoise& noise = first.config.noise;
  std::string text = fmt::format(
      "# kind={} duration_s={} rate_hz={} seed={} nmean={} outlier_fraction={} model={}\n"
      "# v_true = k_v * v_measured ; angles in rad in CSV, degrees here; az + left, el + up\n"
      "# sensor->vehicle: R = Rz(mount_az+alpha) * Ry(-(mount_pitch+beta)) * Rx(mount_roll+gamma); "
      "v_s=(k_v*v - w*y, w*x + V_lat, 0); vr = -(R u).v_s\n"
      "# noise and nmean are those of the first radar\n"
      "k_v {:.6f}\n",
      name_of(spec.road), spec.duration_s, spec.ego_rate_hz, spec.seed, first.mean_detections, spec.outlier_share,
      spec.model == MountingModel::kExact ? "exact" : "planar", spec.speed_scale);
  for (const AlignmentRadar& radar : spec.radars) text += radar_text(radar);
  text += fmt::format(
      "noise sigma_vr {:.3f} m/s sigma_az {:.2f}/max(cos(az),{:.2f}) deg sigma_el {:.2f} deg v_noise {:.3f} "
      "yaw_noise {:.4f} rad/s\n",
      noise.range_rate_std_mps, noise.azimuth_std_rad / kRadiansPerDegree, spec.azimuth_std_edge,
      noise.elevation_std_rad / kRadiansPerDegree, spec.speed_std_mps, spec.yaw_rate_std_radps);
  text += fmt::format(
      "disturbance yaw_rate_bias {:.6f} rad/s (measured = true + bias) rear_slip_coeff {:.4f} rad/(m/s2) "
      "(V_lat=-c*V*(V*w)) pitch_std {:.3f} deg pitch_per_ax {:.4f} rad/(m/s2)\n",
      spec.total_yaw_rate_bias_radps(), spec.total_slip_coefficient_radps2pm(),
      spec.body_pitch_std_rad / kRadiansPerDegree, spec.body_pitch_per_acceleration_radps2pm);
  text += real_car_text(spec);
  for (const StepChange& step_change : spec.step_changes) text += step_change_text(step_change, spec, drive);
  text += fmt::format("stationary residual rmse_uncorrected {:.4f} at_truth {:.4f}\n", residuals.uncorrected_mps,
                      residuals.at_truth_mps);
  if (bound != nullptr) text += bound_text(*bound, spec.radars.size());
  return text;
}

}  // namespace boresight::simulator
