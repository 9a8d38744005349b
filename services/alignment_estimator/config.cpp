#include "services/alignment_estimator/config.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/header.hpp"
#include "services/common/runtime/config/read_text.hpp"

namespace boresight::alignment {

namespace {

/// Two estimates before readers take the service for late.
constexpr double kMaxPublishPeriod_s =
    0.5e-9 * static_cast<double>(catalogue::topic(catalogue::TopicId::kAlignmentEstimate).deadline_ns);

/// Standard deviations before any data. 0 switches a parameter off.
void read_prior(config::Reader table, windows::Priors& p, FilterConfig& filter) {
  p.speed_scale_std = table.number("speed_scale_std", {0.0, 0.5}, p.speed_scale_std);
  p.rate_scale_std = table.number("range_rate_scale_std", {0.0, 0.1}, p.rate_scale_std);
  p.rotation_std_rad = table.angle_deg("rotation_std_deg", {0.1, 30.0}, p.rotation_std_rad);
  p.turned_std_rad = table.angle_deg("turned_std_deg", {0.1, 30.0}, p.turned_std_rad);
  p.yaw_rate_bias_std_radps = table.angle_deg("yaw_rate_bias_std_deg", {0.0, 10.0}, p.yaw_rate_bias_std_radps);
  p.yaw_rate_gain_std = table.number("yaw_rate_gain_std", {0.0, 0.5}, p.yaw_rate_gain_std);
  p.slip_std_radps2pm = table.number("slip_coefficient_std", {0.0, 0.1}, p.slip_std_radps2pm);
  p.pitch_per_acceleration_std_radps2pm =
      table.number("pitch_per_acceleration_std", {0.0, 0.1}, p.pitch_per_acceleration_std_radps2pm);
  p.common_stamp_std_s = table.number("common_time_offset_std_s", {0.0, 1.0}, p.common_stamp_std_s);
  p.stamp_std_s = table.number("time_offset_std_s", {0.0, 1.0}, p.stamp_std_s);
  p.position_std_m = table.number("position_std_m", {0.0, 2.0}, p.position_std_m);
  p.curve_std_rad = table.angle_deg("azimuth_curve_std_deg", {0.0, 5.0}, p.curve_std_rad);
  p.curve_length_rad = table.angle_deg("azimuth_curve_length_deg", {1.0, 90.0}, p.curve_length_rad);
  p.height_excess_std = table.number("height_excess_std", {0.0, 5.0}, p.height_excess_std);
  p.mirror_share_std = table.number("mirror_share_std", {0.0, 5.0}, p.mirror_share_std);
  p.mirror_share_tolerance = table.number("mirror_share_tolerance", {0.0, 1.0}, p.mirror_share_tolerance);
  p.load_std_rad = table.angle_deg("load_pitch_std_deg", {0.0, 10.0}, p.load_std_rad);
  filter.prior_angle_noise_log_std = table.number("angle_noise_log_std", {0.01, 3.0}, filter.prior_angle_noise_log_std);
}

/// Fluctuations that the model has no cause for; the order of windows::kFluctuating.
void read_fluctuation(config::Reader table, windows::Priors& p) {
  const auto read = [&](const std::string& whose, std::array<double, windows::kFluctuations>& std) {
    std[0] = table.angle_deg(whose + "yaw_std_deg", {0.0, 5.0}, std[0]);
    std[1] = table.angle_deg(whose + "pitch_std_deg", {0.0, 5.0}, std[1]);
    std[2] = table.number(whose + "scale_std", {0.0, 0.1}, std[2]);
  };
  read("", p.own_std);
  read("common_", p.common_std);
  p.roll_per_pitch = table.number("roll_per_pitch", {0.0, 100.0}, p.roll_per_pitch);
  p.lasting_pitch = table.number("lasting_pitch", {0.0, 10.0}, p.lasting_pitch);
  p.log_fluctuation_std = table.number("log_std", {0.01, 5.0}, p.log_fluctuation_std);
  p.common_correlation_s = table.number("correlation_s", {1.5, 60.0}, p.common_correlation_s);
  p.log_correlation_std = table.number("log_correlation_std", {0.01, 5.0}, p.log_correlation_std);
}

void read_sums(config::Reader table, windows::SumsConfig& s) {
  s.noise_memory_s = table.number("noise_memory_s", {1.0, 3600.0}, s.noise_memory_s);
  s.spread_memory_s = table.number("spread_memory_s", {1.0, 36000.0}, s.spread_memory_s);
  s.gate_scale = table.number("gate_scale", {0.0, 0.1}, s.gate_scale);
  s.start_gate_scale = table.number("start_gate_scale", {0.0, 0.1}, s.start_gate_scale);
  s.gate_yaw_rad = table.angle_deg("gate_yaw_deg", {0.0, 10.0}, s.gate_yaw_rad);
  s.wide_share = table.number("wide_share", {0.0, 0.1}, s.wide_share);
  s.clear_acceleration_mps2 = table.number("clear_acceleration_mps2", {0.0, 5.0}, s.clear_acceleration_mps2);
  s.clear_yaw_acceleration_radps2 =
      table.angle_deg("clear_yaw_acceleration_deg", {0.0, 90.0}, s.clear_yaw_acceleration_radps2);
  s.known_share = table.number("known_share", {0.01, 1.0}, s.known_share);
}

void read_changes(config::Reader& filter, windows::ChangeConfig& c) {
  config::Reader radar = filter.table("step_change");
  c.yaw_rad = radar.angle_deg("yaw_deg", {0.05, 10.0}, c.yaw_rad);
  c.pitch_rad = radar.angle_deg("pitch_deg", {0.05, 10.0}, c.pitch_rad);
  c.scatter_factor = radar.number("scatter_factor", {1.0, 100.0}, c.scatter_factor);
  c.common_factor = radar.number("common_factor", {1.0, 100.0}, c.common_factor);
  c.yaw_scatter_rad = radar.angle_deg("yaw_scatter_deg", {0.001, 5.0}, c.yaw_scatter_rad);
  c.pitch_scatter_rad = radar.angle_deg("pitch_scatter_deg", {0.001, 5.0}, c.pitch_scatter_rad);
  c.least_detections = radar.number("least_detections", {1.0, 10000.0}, c.least_detections);
  c.wait_s = radar.number("wait_s", {0.0, 3600.0}, c.wait_s);
  c.prior_blocks = radar.number("prior_blocks", {0.0, 1000.0}, c.prior_blocks);
  c.settled_blocks =
      static_cast<std::size_t>(radar.integer("settled_blocks", {1, 150}, static_cast<std::int64_t>(c.settled_blocks)));
  c.unsure_s = radar.number("unsure_s", {0.0, 60.0}, c.unsure_s);
  c.settled_yaw_rad = radar.angle_deg("settled_yaw_deg", {0.001, 30.0}, c.settled_yaw_rad);
  const auto read_common = [](config::Reader& table, windows::CommonConfig& common) {
    common.stds = table.number("stds", {1.0, 100.0}, common.stds);
    common.prior_blocks = table.number("prior_blocks", {0.0, 1000.0}, common.prior_blocks);
    common.later_share = table.number("later_share", {0.0, 1.0}, common.later_share);
    common.after = static_cast<std::size_t>(table.integer("blocks", {4, 30}, static_cast<std::int64_t>(common.after)));
  };
  config::Reader load = filter.table("load_change");
  c.load.least = load.angle_deg("least_deg", {0.01, 10.0}, c.load.least);
  c.load.scatter = load.angle_deg("scatter_deg", {0.001, 5.0}, c.load.scatter);
  read_common(load, c.load);
  c.load.between_radars = load.angle_deg("between_radars_deg", {0.001, 5.0}, c.load.between_radars);
  c.load_after_restart_stds = load.number("after_restart_stds", {1.0, 100.0}, c.load_after_restart_stds);
  c.load_wait_s = load.number("wait_s", {0.0, 3600.0}, c.load_wait_s);
  c.watch_s = load.number("watch_s", {1.0, 3600.0}, c.watch_s);
  config::Reader speed = filter.table("speed_change");
  c.speed.least = speed.number("least", {1e-4, 0.2}, c.speed.least);
  c.speed.scatter = speed.number("scatter", {1e-5, 0.1}, c.speed.scatter);
  c.speed.between_radars = speed.number("between_radars", {1e-5, 0.1}, c.speed.between_radars);
  c.suspect_scale = speed.number("suspect", {1e-4, 1.0}, c.suspect_scale);
  read_common(speed, c.speed);
}

void read_filter(config::Reader table, FilterConfig& c, windows::WindowsConfig& w) {
  c.min_speed_mps = table.number("min_speed_mps", {1.0, 50.0}, c.min_speed_mps);
  c.outlier_gate_sigma = table.number("outlier_gate_sigma", {2.0, 20.0}, c.outlier_gate_sigma);
  c.azimuth_std_edge = table.number("azimuth_std_edge", {0.05, 1.0}, c.azimuth_std_edge);
  read_prior(table.table("prior"), w.priors, c);
  read_fluctuation(table.table("fluctuation"), w.priors);
  read_sums(table.table("sums"), w.sums);

  config::Reader drift = table.table("drift");
  constexpr double kPerMinute = 60.0;
  w.priors.drift_std_radps =
      drift.angle_deg("std_deg_per_min", {0.0, 10.0}, w.priors.drift_std_radps * kPerMinute) / kPerMinute;
  w.priors.drift_span_s = drift.number("span_s", {10.0, 36000.0}, w.priors.drift_span_s);
  w.change.drift_rad = drift.angle_deg("least_deg", {0.01, 10.0}, w.change.drift_rad);
  w.change.drift_stds = drift.number("stds", {1.0, 100.0}, w.change.drift_stds);

  config::Reader motion = table.table("motion");
  c.speed_std_mps = motion.number("speed_std_mps", {1e-4, 5.0}, c.speed_std_mps);
  c.yaw_rate_std_radps = motion.angle_deg("yaw_rate_std_deg", {1e-4, 10.0}, c.yaw_rate_std_radps);
  w.priors.body_pitch_std_rad = motion.angle_deg("body_pitch_std_deg", {0.0, 5.0}, w.priors.body_pitch_std_rad);
  w.priors.side_slip_std_rad = motion.angle_deg("side_slip_std_deg", {0.0, 5.0}, w.priors.side_slip_std_rad);

  config::Reader start = table.table("start");
  c.start_seconds = start.number("seconds", {0.05, 60.0}, c.start_seconds);
  c.start_detections = start.number("detections", {10.0, 2000.0}, c.start_detections);
  c.start_passes = static_cast<int>(start.integer("passes", {1, 100}, c.start_passes));
  c.start_scale_mps = start.number("scale_mps", {0.05, 50.0}, c.start_scale_mps);
  c.start_shrink = start.number("shrink", {0.1, 0.99}, c.start_shrink);

  config::Reader convergence = table.table("convergence");
  c.converged_yaw_std_rad = convergence.angle_deg("yaw_std_deg", {0.001, 5.0}, c.converged_yaw_std_rad);
  c.min_seconds_to_converge = convergence.number("min_seconds", {0.0, 600.0}, c.min_seconds_to_converge);
  c.min_inlier_share = convergence.number("min_inlier_share", {0.0, 0.9}, c.min_inlier_share);
  c.inlier_memory_s = convergence.number("inlier_memory_s", {0.1, 600.0}, c.inlier_memory_s);
  c.max_noise_scale = convergence.number("max_noise_scale", {1.0, 3.4}, c.max_noise_scale);

  config::Reader remembered = table.table("remembered");
  windows::RestoreConfig& r = w.restore;
  r.doubt_s = remembered.number("doubt_s", {1.0, 1e6}, r.doubt_s);
  r.stop_s = remembered.number("stop_s", {0.0, 3600.0}, r.stop_s);
  r.rotation_std_rad = remembered.angle_deg("rotation_std_deg", {0.0, 30.0}, r.rotation_std_rad);
  r.rate_scale_std = remembered.number("range_rate_scale_std", {0.0, 0.1}, r.rate_scale_std);
  r.speed_scale_std = remembered.number("speed_scale_std", {0.0, 0.5}, r.speed_scale_std);
  r.vehicle_share = remembered.number("vehicle_share", {0.0, 1.0}, r.vehicle_share);

  read_changes(table, w.change);
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

PlausibilityConfig read_plausibility(config::Reader table) {
  PlausibilityConfig c;
  c.enabled = table.boolean("enabled", c.enabled);
  c.window_s = table.number("window_s", {0.1, 5.0}, c.window_s);
  c.least_share = table.number("least_share", {0.05, 1.0}, c.least_share);
  c.yaw_limit_rad = table.angle_deg("yaw_limit_deg", {2.0, 45.0}, c.yaw_limit_rad);
  c.prior_log_odds = table.number("prior_log_odds", {0.0, 30.0}, c.prior_log_odds);
  c.margin_log = table.number("margin_log", {1.0, 50.0}, c.margin_log);
  c.least_s = table.number("least_s", {0.5, 600.0}, c.least_s);
  return c;
}

std::optional<DriveTruth> read_truth(config::Reader& root) {
  std::string path = root.text("truth_file", "");
  const char* const from_environment = std::getenv("BORESIGHT_TRUTH");
  if (from_environment != nullptr) path = from_environment;
  if (path.empty()) return std::nullopt;
  std::string problem = "no truth of a simulated drive in " + path;
  try {
    std::istringstream file(config::read_text(path));
    DriveTruth truth = read_drive_truth(file);
    if (truth.known() && std::isfinite(truth.speed_scale)) return truth;
  } catch (const config::Error& error) {
    problem += fmt::format(" ({})", error.what());
  }
  problem += "; must be the truth.csv of a simulated drive, or \"\"";
  if (from_environment != nullptr) throw config::Error("$BORESIGHT_TRUTH: " + problem);
  root.reject("truth_file", problem);
  return std::nullopt;
}

/// A file of that name is replaced by a renamed one: it must not be a folder, pipe or device.
void check_memory_path(config::Reader& table, const std::string& path) {
  std::error_code ignored;
  if (path.empty()) return;
  if (!std::filesystem::path(path).has_filename() ||
      (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))) {
    table.reject("path", fmt::format("\"{}\" is no file; must be the path of a regular file, or \"\"", path));
  }
}

}  // namespace

Settings read_settings(config::Reader root) {
  Settings settings;
  Config& c = settings.estimator;
  c.method = root.choice<MethodName>("method", {kMethodNames.begin(), kMethodNames.end()}, c.method);
  c.publish_period_s = root.number("publish_period_s", {0.05, kMaxPublishPeriod_s}, c.publish_period_s);
  c.kpi_window_s = root.number("kpi_window_s", {1.0, 3600.0}, c.kpi_window_s);
  c.residual_gate_sigma = root.number("residual_gate_sigma", {2.0, 20.0}, c.residual_gate_sigma);
  read_filter(root.table("filter"), c.filter, c.windows);
  c.published = read_published(root.table("published"));
  c.plausibility = read_plausibility(root.table("plausibility"));
  c.truth = read_truth(root);
  MemorySettings& memory = settings.memory;
  config::Reader memory_table = root.table("memory");
  memory.enabled = memory_table.boolean("enabled", memory.enabled);
  memory.path = memory_table.text("path", memory.path);
  check_memory_path(memory_table, memory.path);
  memory.period_s = memory_table.number("period_s", {1.0, 3600.0}, memory.period_s);
  settings.station = station::read_settings(root.table("station"));
  root.finish();
  return settings;
}

}  // namespace boresight::alignment
