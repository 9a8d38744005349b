#include "services/alignment_estimator/config.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "interfaces/messages/header.hpp"

namespace boresight::alignment {

namespace {

FilterConfig read_filter(config::Reader table) {
  FilterConfig c;
  c.min_speed_mps = table.number("min_speed_mps", {1.0, 50.0}, c.min_speed_mps);
  c.outlier_gate_sigma = table.number("outlier_gate_sigma", {2.0, 20.0}, c.outlier_gate_sigma);
  c.azimuth_std_edge = table.number("azimuth_std_edge", {0.05, 1.0}, c.azimuth_std_edge);

  config::Reader prior = table.table("prior");
  c.prior_speed_scale_std = prior.number("speed_scale_std", {1e-4, 0.5}, c.prior_speed_scale_std);
  c.prior_rotation_std_rad = prior.angle_deg("rotation_std_deg", {0.1, 30.0}, c.prior_rotation_std_rad);
  c.prior_yaw_rate_bias_std_radps =
      prior.angle_deg("yaw_rate_bias_std_deg", {0.0, 10.0}, c.prior_yaw_rate_bias_std_radps);
  c.prior_slip_coefficient_std_radps2pm =
      prior.number("slip_coefficient_std", {0.0, 0.1}, c.prior_slip_coefficient_std_radps2pm);
  c.prior_pitch_per_acceleration_std_radps2pm =
      prior.number("pitch_per_acceleration_std", {0.0, 0.1}, c.prior_pitch_per_acceleration_std_radps2pm);
  c.prior_angle_noise_log_std = prior.number("angle_noise_log_std", {0.01, 3.0}, c.prior_angle_noise_log_std);

  config::Reader drift = table.table("drift");
  c.rotation_drift_rad_per_sqrt_s =
      drift.angle_deg("rotation_per_sqrt_s_deg", {0.0, 1.0}, c.rotation_drift_rad_per_sqrt_s);
  c.speed_scale_drift_per_sqrt_s = drift.number("speed_scale_per_sqrt_s", {0.0, 0.1}, c.speed_scale_drift_per_sqrt_s);
  c.yaw_rate_bias_drift_radps_per_sqrt_s =
      drift.angle_deg("yaw_rate_bias_per_sqrt_s_deg", {0.0, 1.0}, c.yaw_rate_bias_drift_radps_per_sqrt_s);

  config::Reader motion = table.table("motion");
  c.speed_std_mps = motion.number("speed_std_mps", {1e-4, 5.0}, c.speed_std_mps);
  c.yaw_rate_std_radps = motion.angle_deg("yaw_rate_std_deg", {1e-4, 10.0}, c.yaw_rate_std_radps);
  c.body_pitch_std_rad = motion.angle_deg("body_pitch_std_deg", {1e-4, 5.0}, c.body_pitch_std_rad);
  c.side_slip_std_rad = motion.angle_deg("side_slip_std_deg", {1e-4, 5.0}, c.side_slip_std_rad);
  c.ego_correlation_s = motion.number("ego_correlation_s", {1e-3, 60.0}, c.ego_correlation_s);
  c.body_correlation_s = motion.number("body_correlation_s", {1e-3, 60.0}, c.body_correlation_s);
  c.nuisance_memory_s = motion.number("memory_s", {1.0, 36000.0}, c.nuisance_memory_s);

  config::Reader start = table.table("start");
  c.start_seconds = start.number("seconds", {0.05, 60.0}, c.start_seconds);
  c.start_detections = start.number("detections", {10.0, 2000.0}, c.start_detections);
  c.start_passes = static_cast<int>(start.integer("passes", {1, 100}, c.start_passes));
  c.start_scale_mps = start.number("scale_mps", {0.05, 50.0}, c.start_scale_mps);
  c.start_shrink = start.number("shrink", {0.1, 0.99}, c.start_shrink);
  c.start_inflation = start.number("inflation", {1.0, 1000.0}, c.start_inflation);

  config::Reader convergence = table.table("convergence");
  c.converged_yaw_std_rad = convergence.angle_deg("yaw_std_deg", {0.001, 5.0}, c.converged_yaw_std_rad);
  c.min_seconds_to_converge = convergence.number("min_seconds", {0.0, 600.0}, c.min_seconds_to_converge);

  config::Reader remembered = table.table("remembered");
  c.memory_inflation = remembered.number("inflation", {1.0, 1000.0}, c.memory_inflation);
  c.memory_rotation_std_rad = remembered.angle_deg("rotation_std_deg", {0.0, 30.0}, c.memory_rotation_std_rad);
  c.memory_speed_scale_std = remembered.number("speed_scale_std", {0.0, 0.5}, c.memory_speed_scale_std);

  config::Reader step_change = table.table("step_change");
  c.step_change_block_s = step_change.number("block_s", {0.1, 60.0}, c.step_change_block_s);
  c.step_change_yaw_rad = step_change.angle_deg("yaw_deg", {0.05, 30.0}, c.step_change_yaw_rad);
  c.step_change_pitch_rad = step_change.angle_deg("pitch_deg", {0.05, 30.0}, c.step_change_pitch_rad);
  c.step_change_sum_blocks = step_change.number("sum_blocks", {0.1, 100.0}, c.step_change_sum_blocks);
  c.step_change_window_s = step_change.number("window_s", {0.1, 60.0}, c.step_change_window_s);
  c.step_change_small_stds = step_change.number("small_stds", {0.1, 100.0}, c.step_change_small_stds);
  c.step_change_small_sum_stds = step_change.number("small_sum_stds", {0.1, 100.0}, c.step_change_small_sum_stds);
  c.step_change_small_confirm_stds =
      step_change.number("small_confirm_stds", {0.1, 100.0}, c.step_change_small_confirm_stds);
  c.step_change_least_rad = step_change.angle_deg("least_deg", {0.0, 30.0}, c.step_change_least_rad);
  return c;
}

std::array<double, 4> four(config::Reader& table, std::string_view key, config::Range allowed,
                           const std::array<double, 4>& fallback) {
  const std::vector<double> values = table.numbers(key, 4, allowed, {fallback.begin(), fallback.end()});
  return {values[0], values[1], values[2], values[3]};
}

published::PublishedConfig read_published(config::Reader table) {
  using published::RoadModel;
  published::PublishedConfig c;
  c.road_model = table.choice<RoadModel>("road_model",
                                         {{"full", RoadModel::kFull},
                                          {"straight_where_slow", RoadModel::kStraightWhereSlow},
                                          {"straight", RoadModel::kStraight}},
                                         c.road_model);
  c.straight_yaw_rate_radps = table.angle_deg("straight_yaw_rate_deg", {0.0, 10.0}, c.straight_yaw_rate_radps);
  c.min_speed_mps = table.number("min_speed_mps", {1.0, 50.0}, c.min_speed_mps);
  c.steepest_descent_rate = four(table, "steepest_descent_rate", {0.0, 1.0}, c.steepest_descent_rate);
  c.least_squares_rate = four(table, "nls_rate", {0.0, 1.0}, c.least_squares_rate);
  c.least_squares_damping = table.number("nls_damping", {0.0, 1e6}, c.least_squares_damping);
  c.total_least_squares_rate = table.number("tls_rate", {0.0, 1.0}, c.total_least_squares_rate);
  c.nelder_mead_detections = static_cast<std::size_t>(table.integer(
      "nelder_mead_detections", {4, kMaxDetections}, static_cast<std::int64_t>(c.nelder_mead_detections)));
  c.nelder_mead_iterations =
      static_cast<int>(table.integer("nelder_mead_iterations", {1, 1000}, c.nelder_mead_iterations));
  c.nelder_mead_filter_scans = table.number("nelder_mead_filter_scans", {1.0, 1e6}, c.nelder_mead_filter_scans);
  c.nelder_mead_edge = four(table, "nelder_mead_edge", {1e-6, 1.0}, c.nelder_mead_edge);
  c.gate = table.boolean("gate", c.gate);
  c.gate_sigma = table.number("gate_sigma", {1.0, 20.0}, c.gate_sigma);
  c.gate_floor_mps = table.number("gate_floor_mps", {0.0, 5.0}, c.gate_floor_mps);
  c.min_detections = static_cast<std::size_t>(
      table.integer("min_detections", {1, kMaxDetections}, static_cast<std::int64_t>(c.min_detections)));
  c.max_speed_scale_error = table.number("max_speed_scale_error", {0.001, 0.5}, c.max_speed_scale_error);
  c.max_angle_rad = table.angle_deg("max_angle_deg", {0.1, 45.0}, c.max_angle_rad);
  c.prior_speed_scale_std = table.number("prior_speed_scale_std", {1e-4, 0.5}, c.prior_speed_scale_std);
  c.prior_angle_std_rad = table.angle_deg("prior_angle_std_deg", {0.1, 30.0}, c.prior_angle_std_rad);
  c.window_s = table.number("window_s", {0.1, 36000.0}, c.window_s);
  c.converged_angle_rad = table.angle_deg("converged_angle_deg", {0.001, 10.0}, c.converged_angle_rad);
  c.converged_speed_scale = table.number("converged_speed_scale", {1e-6, 0.1}, c.converged_speed_scale);
  c.seed = static_cast<std::uint64_t>(table.integer("seed", {0, 1e15}, static_cast<std::int64_t>(c.seed)));
  return c;
}

std::optional<DriveTruth> read_truth(config::Reader& root) {
  std::string path = root.text("truth_file", "");
  const char* const from_environment = std::getenv("BORESIGHT_TRUTH");
  if (from_environment != nullptr) path = from_environment;
  if (path.empty()) return std::nullopt;
  std::ifstream file(path);
  DriveTruth truth = read_drive_truth(file);
  if (truth.known() && std::isfinite(truth.speed_scale)) return truth;
  const std::string problem = "no truth of a simulated drive in " + path;
  if (from_environment != nullptr) throw config::Error("$BORESIGHT_TRUTH: " + problem);
  root.reject("truth_file", problem);
  return std::nullopt;
}

}  // namespace

Settings read_settings(config::Reader root) {
  Settings settings;
  Config& c = settings.estimator;
  c.method = root.choice<MethodName>("method", {kMethodNames.begin(), kMethodNames.end()}, c.method);
  c.publish_period_s = root.number("publish_period_s", {0.05, 10.0}, c.publish_period_s);
  c.kpi_window_s = root.number("kpi_window_s", {1.0, 3600.0}, c.kpi_window_s);
  c.residual_gate_sigma = root.number("residual_gate_sigma", {2.0, 20.0}, c.residual_gate_sigma);
  c.filter = read_filter(root.table("filter"));
  c.published = read_published(root.table("published"));
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
