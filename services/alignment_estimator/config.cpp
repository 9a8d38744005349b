#include "services/alignment_estimator/config.hpp"

#include "interfaces/messages/header.hpp"

namespace boresight::alignment {

namespace {

std::optional<Truth> read_truth(config::Reader root) {
  if (!root.has("truth")) return std::nullopt;
  config::Reader table = root.table("truth");
  Truth truth;
  truth.speed_scale = table.number("speed_scale", {0.5, 2.0}, truth.speed_scale);
  for (config::Reader& entry : table.tables("radar")) {
    Truth::Radar radar;
    entry.require("id");
    radar.id = static_cast<std::uint32_t>(entry.integer("id", {1, kMaxRadars}, 1));
    radar.yaw_rad = entry.angle_deg("yaw_deg", {-45.0, 45.0}, 0.0);
    radar.pitch_rad = entry.angle_deg("pitch_deg", {-45.0, 45.0}, 0.0);
    radar.roll_rad = entry.angle_deg("roll_deg", {-45.0, 45.0}, 0.0);
    truth.radars.push_back(radar);
  }
  return truth;
}

}  // namespace

Settings read_settings(config::Reader root) {
  Settings settings;
  Config& c = settings.estimator;
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
  c.residual_gate_sigma = root.number("residual_gate_sigma", {2.0, 20.0}, c.residual_gate_sigma);
  c.truth = read_truth(root);
  MemorySettings& memory = settings.memory;
  config::Reader memory_table = root.table("memory");
  memory.enabled = memory_table.boolean("enabled", memory.enabled);
  memory.path = memory_table.text("path", memory.path);
  memory.period_s = memory_table.number("period_s", {1.0, 3600.0}, memory.period_s);
  settings.station = station::read_settings(root.table("station"));
  root.finish();
  return settings;
}

}  // namespace boresight::alignment
