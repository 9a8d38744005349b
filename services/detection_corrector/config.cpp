#include "services/detection_corrector/config.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace boresight::corrector {

namespace {

/// Smallest side of the region of interest: in a smaller one no object has room.
constexpr double kMinRegionSide_m = 1.0;

void read_corner(config::Reader& reader, std::string_view key, std::array<double, 3>& corner) {
  const auto values = reader.numbers(key, 3, {-1000.0, 1000.0}, {corner.begin(), corner.end()});
  std::copy(values.begin(), values.end(), corner.begin());
}

}  // namespace

Config read_config(config::Reader root) {
  Config c;
  config::Reader region = root.table("region_of_interest");
  read_corner(region, "min_m", c.region_min_m);
  read_corner(region, "max_m", c.region_max_m);
  for (std::size_t i = 0; i < 3; ++i) {
    if (c.region_max_m[i] - c.region_min_m[i] >= kMinRegionSide_m) continue;
    region.reject("min_m", fmt::format("must be below max_m by at least {} m in every element", kMinRegionSide_m));
    break;
  }
  config::Reader rcs = root.table("rcs_threshold");
  c.rcs_near_dbsm = rcs.number("near_dbsm", {-100.0, 30.0}, c.rcs_near_dbsm);
  c.rcs_slope_db_per_decade = rcs.number("slope_db_per_decade", {-40.0, 40.0}, c.rcs_slope_db_per_decade);
  config::Reader moving = root.table("moving");
  c.moving_sigma = moving.number("sigma", {1.0, 10.0}, c.moving_sigma);
  c.body_motion_std_mps = moving.number("body_motion_std_mps", {0.0, 1.0}, c.body_motion_std_mps);
  c.azimuth_std_edge = moving.number("azimuth_std_edge", {0.01, 1.0}, c.azimuth_std_edge);
  config::Reader noise = root.table("stated_noise");
  StatedNoiseConfig& n = c.stated_noise;
  n.prior_detections = noise.number("prior_detections", {1.0, 1e6}, n.prior_detections);
  n.time_constant_s = noise.number("time_constant_s", {1.0, 36000.0}, n.time_constant_s);
  n.other_share = noise.number("other_share", {0.001, 0.5}, n.other_share);
  n.other_width_mps = noise.number("other_width_mps", {0.5, 100.0}, n.other_width_mps);
  n.least_scale = noise.number("least_scale", {0.01, 1.0}, n.least_scale);
  n.most_scale = noise.number("most_scale", {1.0, 100.0}, n.most_scale);
  n.least_speed_mps = noise.number("least_speed_mps", {0.0, 50.0}, n.least_speed_mps);
  config::Reader unknown = root.table("unknown");
  c.unknown_rotation_std_rad = unknown.angle_deg("rotation_std_deg", {0.0, 20.0}, c.unknown_rotation_std_rad);
  c.unknown_speed_scale_std = unknown.number("speed_scale_std", {0.0, 0.5}, c.unknown_speed_scale_std);
  c.unknown_yaw_rate_bias_std_radps =
      unknown.angle_deg("yaw_rate_bias_std_deg", {0.0, 10.0}, c.unknown_yaw_rate_bias_std_radps);
  c.unknown_slip_std_radps2pm = unknown.number("slip_std", {0.0, 0.1}, c.unknown_slip_std_radps2pm);
  config::Reader side = root.table("side_inputs");
  c.max_angle_std_to_apply_rad = side.angle_deg("max_angle_std_deg", {0.001, 10.0}, c.max_angle_std_to_apply_rad);
  c.max_speed_scale_std_to_apply = side.number("max_speed_scale_std", {1e-5, 1.0}, c.max_speed_scale_std_to_apply);
  c.alignment_max_age_s = side.number("alignment_max_age_s", {0.1, 3600.0}, c.alignment_max_age_s);
  c.ego_max_age_s = side.number("ego_max_age_s", {0.01, 10.0}, c.ego_max_age_s);
  root.finish();
  return c;
}

}  // namespace boresight::corrector
