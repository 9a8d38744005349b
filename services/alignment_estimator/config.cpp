#include "services/alignment_estimator/config.hpp"

namespace boresight::alignment {

Config read_config(config::Reader root) {
  Config c;
  c.method = root.choice<MethodName>("method", {{"azimuth_1d", MethodName::kAzimuth1d}}, c.method);
  c.min_speed_mps = root.number("min_speed_mps", {1.0, 50.0}, c.min_speed_mps);
  c.publish_period_s = root.number("publish_period_s", {0.05, 10.0}, c.publish_period_s);
  config::Reader prior = root.table("prior");
  c.prior_yaw_std_rad = prior.angle_deg("yaw_std_deg", {0.1, 30.0}, c.prior_yaw_std_rad);
  c.prior_speed_scale_std = prior.number("speed_scale_std", {1e-4, 0.5}, c.prior_speed_scale_std);
  config::Reader drift = root.table("drift");
  c.yaw_drift_rad_per_sqrt_s = drift.angle_deg("yaw_deg_per_sqrt_s", {0.0, 1.0}, c.yaw_drift_rad_per_sqrt_s);
  c.speed_scale_drift_per_sqrt_s = drift.number("speed_scale_per_sqrt_s", {0.0, 0.1}, c.speed_scale_drift_per_sqrt_s);
  config::Reader robust = root.table("robustness");
  c.outlier_gate_sigma = robust.number("outlier_gate_sigma", {2.0, 20.0}, c.outlier_gate_sigma);
  c.start_gate_mps = robust.number("start_gate_mps", {0.0, 5.0}, c.start_gate_mps);
  c.start_duration_s = robust.number("start_duration_s", {0.1, 60.0}, c.start_duration_s);
  c.ego_error_correlation_s = robust.number("ego_error_correlation_s", {0.0, 60.0}, c.ego_error_correlation_s);
  config::Reader convergence = root.table("convergence");
  c.converged_yaw_std_rad = convergence.angle_deg("yaw_std_deg", {0.001, 5.0}, c.converged_yaw_std_rad);
  c.min_seconds_to_converge = convergence.number("min_seconds", {0.0, 600.0}, c.min_seconds_to_converge);
  c.systematic_yaw_std_rad = convergence.angle_deg("systematic_yaw_std_deg", {0.0, 5.0}, c.systematic_yaw_std_rad);
  c.systematic_speed_scale_std =
      convergence.number("systematic_speed_scale_std", {0.0, 0.1}, c.systematic_speed_scale_std);
  c.kpi_window_s = root.number("kpi_window_s", {1.0, 3600.0}, c.kpi_window_s);
  root.finish();
  return c;
}

}  // namespace boresight::alignment
