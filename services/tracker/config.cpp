#include "services/tracker/config.hpp"

namespace boresight::tracking {

namespace {

std::size_t count(config::Reader& reader, std::string_view key, std::size_t fallback) {
  return static_cast<std::size_t>(reader.integer(key, {1, 32}, static_cast<std::int64_t>(fallback)));
}

}  // namespace

Config read_config(config::Reader root) {
  Config c;
  config::Reader clusters = root.table("clusters");
  c.cluster_radius_m = clusters.number("radius_m", {0.1, 20.0}, c.cluster_radius_m);
  c.cluster_min_points = count(clusters, "min_points", c.cluster_min_points);
  c.cluster_max_range_rate_spread_mps =
      clusters.number("max_range_rate_spread_mps", {0.1, 50.0}, c.cluster_max_range_rate_spread_mps);
  config::Reader filter = root.table("filter");
  c.gate_chi2 = filter.number("gate_chi2", {1.0, 100.0}, c.gate_chi2);
  c.jerk_std_mps3 = filter.number("jerk_std_mps3", {0.01, 100.0}, c.jerk_std_mps3);
  c.centre_std_m = filter.number("centre_std_m", {0.01, 10.0}, c.centre_std_m);
  c.range_rate_std_mps = filter.number("range_rate_std_mps", {0.01, 10.0}, c.range_rate_std_mps);
  c.start_position_std_m = filter.number("start_position_std_m", {0.0, 20.0}, c.start_position_std_m);
  c.start_speed_std_mps = filter.number("start_speed_std_mps", {0.1, 100.0}, c.start_speed_std_mps);
  c.start_acceleration_std_mps2 =
      filter.number("start_acceleration_std_mps2", {0.1, 50.0}, c.start_acceleration_std_mps2);
  config::Reader parts = root.table("parts");
  c.part_margin_m = parts.number("part_margin_m", {0.0, 20.0}, c.part_margin_m);
  c.duplicate_margin_m = parts.number("duplicate_margin_m", {0.0, 20.0}, c.duplicate_margin_m);
  c.duplicate_speed_mps = parts.number("duplicate_speed_mps", {0.0, 50.0}, c.duplicate_speed_mps);
  config::Reader life = root.table("life");
  c.confirm_hits = count(life, "confirm_hits", c.confirm_hits);
  c.confirm_window = count(life, "confirm_window", c.confirm_window);
  c.confirm_evidence = life.number("confirm_evidence", {0.0, 32.0}, c.confirm_evidence);
  c.confirm_age_s = life.number("confirm_age_s", {0.0, 5.0}, c.confirm_age_s);
  c.confirm_image_age_s = life.number("confirm_image_age_s", {0.0, 60.0}, c.confirm_image_age_s);
  c.confirm_side_image_age_s = life.number("confirm_side_image_age_s", {0.0, 60.0}, c.confirm_side_image_age_s);
  c.confirm_weak_age_s = life.number("confirm_weak_age_s", {0.0, 60.0}, c.confirm_weak_age_s);
  c.start_realness = life.number("start_realness", {0.0, 1.0}, c.start_realness);
  c.delete_misses = count(life, "delete_misses", c.delete_misses);
  c.delete_window = count(life, "delete_window", c.delete_window);
  c.delete_age_s = life.number("delete_age_s", {0.0, 5.0}, c.delete_age_s);
  c.coast_s = life.number("coast_s", {0.05, 10.0}, c.coast_s);
  c.blind_range_rate_mps = life.number("blind_range_rate_mps", {0.0, 10.0}, c.blind_range_rate_mps);
  c.stopped_speed_mps = life.number("stopped_speed_mps", {0.0, 5.0}, c.stopped_speed_mps);
  if (c.confirm_hits > c.confirm_window) life.reject("confirm_hits", "must not exceed confirm_window");
  if (c.confirm_evidence > static_cast<double>(c.confirm_window)) {
    life.reject("confirm_evidence", "must not exceed confirm_window");
  }
  if (c.delete_misses > c.delete_window) life.reject("delete_misses", "must not exceed delete_window");
  root.finish();
  return c;
}

}  // namespace boresight::tracking
