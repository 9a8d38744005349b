#include "services/ghost_filter/config.hpp"

namespace boresight::ghosts {

namespace {

published::Config read_published(config::Reader root) {
  published::Config c;
  config::Reader reflectors = root.table("reflectors");
  c.memory_s = reflectors.number("memory_s", {0.05, 5.0}, c.memory_s);
  c.update_period_s = reflectors.number("update_period_s", {0.0, 1.0}, c.update_period_s);
  c.cell_m = reflectors.number("cell_m", {0.05, 10.0}, c.cell_m);
  c.cluster_radius_m = reflectors.number("cluster_radius_m", {0.1, 20.0}, c.cluster_radius_m);
  const auto count = [&](std::string_view key, std::size_t fallback) {
    return static_cast<std::size_t>(reflectors.integer(key, {1, 1000}, static_cast<std::int64_t>(fallback)));
  };
  c.cluster_min_points = count("cluster_min_points", c.cluster_min_points);
  c.min_segment_points = count("min_segment_points", c.min_segment_points);
  c.min_segment_length_m = reflectors.number("min_segment_length_m", {0.1, 100.0}, c.min_segment_length_m);
  c.max_segment_residual_m = reflectors.number("max_segment_residual_m", {0.01, 10.0}, c.max_segment_residual_m);
  config::Reader tests = root.table("tests");
  c.type2_margin_m = tests.number("type2_margin_m", {0.0, 20.0}, c.type2_margin_m);
  c.type1_margin_m = tests.number("type1_margin_m", {0.0, 20.0}, c.type1_margin_m);
  c.ellipse_margin_m = tests.number("ellipse_margin_m", {0.0, 20.0}, c.ellipse_margin_m);
  c.tracks_max_age_s = tests.number("tracks_max_age_s", {0.05, 10.0}, c.tracks_max_age_s);
  return c;
}

}  // namespace

Config read_config(config::Reader root) {
  Config c;
  c.method = root.choice<MethodName>("method", {{"mirror", MethodName::kMirror}, {"published", MethodName::kPublished}},
                                     c.method);
  c.published = read_published(root.table("published"));
  root.finish();
  return c;
}

}  // namespace boresight::ghosts
