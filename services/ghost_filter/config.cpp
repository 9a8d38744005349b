#include "services/ghost_filter/config.hpp"

namespace boresight::ghosts {

namespace {

published::Config read_published(config::Reader root) {
  published::Config c;
  config::Reader stationary = root.table("stationary");
  c.max_range_rate_mps = stationary.number("max_range_rate_mps", {0.0, 20.0}, c.max_range_rate_mps);
  c.min_expected_range_rate_mps =
      stationary.number("min_expected_range_rate_mps", {0.0, 20.0}, c.min_expected_range_rate_mps);
  config::Reader reflectors = root.table("reflectors");
  c.memory_s = reflectors.number("memory_s", {0.05, 5.0}, c.memory_s);
  c.update_period_s = reflectors.number("update_period_s", {0.0, 1.0}, c.update_period_s);
  c.cell_m = reflectors.number("cell_m", {0.05, 10.0}, c.cell_m);
  c.cluster_length_m = reflectors.number("cluster_length_m", {0.1, 20.0}, c.cluster_length_m);
  c.cluster_width_m = reflectors.number("cluster_width_m", {0.1, 20.0}, c.cluster_width_m);
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

MapConfig read_map(config::Reader reader) {
  MapConfig c;
  c.memory_s = reader.number("memory_s", {0.1, 10.0}, c.memory_s);
  c.update_period_s = reader.number("update_period_s", {0.0, 1.0}, c.update_period_s);
  c.search_period_s = reader.number("search_period_s", {0.0, 5.0}, c.search_period_s);
  c.cell_m = reader.number("cell_m", {0.1, 5.0}, c.cell_m);
  c.cluster_radius_m = reader.number("cluster_radius_m", {0.1, 20.0}, c.cluster_radius_m);
  c.cluster_min_cells = static_cast<std::size_t>(
      reader.integer("cluster_min_cells", {1, 1000}, static_cast<std::int64_t>(c.cluster_min_cells)));
  c.tolerance_m = reader.number("tolerance_m", {0.02, 3.0}, c.tolerance_m);
  c.min_cells =
      static_cast<std::size_t>(reader.integer("min_cells", {1, 1000}, static_cast<std::int64_t>(c.min_cells)));
  c.min_length_m = reader.number("min_length_m", {0.5, 100.0}, c.min_length_m);
  c.max_gap_m = reader.number("max_gap_m", {0.5, 50.0}, c.max_gap_m);
  c.min_purity = reader.number("min_purity", {0.0, 1.0}, c.min_purity);
  c.max_curvature_per_m = reader.number("max_curvature_per_m", {0.0, 0.5}, c.max_curvature_per_m);
  c.bin_m = reader.number("bin_m", {0.2, 20.0}, c.bin_m);
  return c;
}

ClassConfig read_classes(config::Reader reader) {
  ClassConfig c;
  c.decision_probability = reader.number("decision_probability", {0.01, 0.99}, c.decision_probability);
  c.memory_s = reader.number("memory_s", {0.0, 2.0}, c.memory_s);
  c.sighting_s = reader.number("sighting_s", {0.0, 2.0}, c.sighting_s);
  c.new_object_density = reader.number("new_object_density", {1e-12, 1.0}, c.new_object_density);
  c.clutter_density = reader.number("clutter_density", {0.0, 1.0}, c.clutter_density);
  c.lone_ghost_density = reader.number("lone_ghost_density", {0.0, 1.0}, c.lone_ghost_density);
  c.hidden_ghost_density = reader.number("hidden_ghost_density", {0.0, 1.0}, c.hidden_ghost_density);
  c.type1_per_object = reader.number("type1_per_object", {0.0, 100.0}, c.type1_per_object);
  c.type1_unheard = reader.number("type1_unheard", {0.0, 1.0}, c.type1_unheard);
  c.type2_per_object = reader.number("type2_per_object", {0.0, 100.0}, c.type2_per_object);
  c.real_per_object = reader.number("real_per_object", {0.01, 100.0}, c.real_per_object);
  c.real_per_truck = reader.number("real_per_truck", {0.01, 100.0}, c.real_per_truck);
  c.tentative_weight = reader.number("tentative_weight", {0.0, 1.0}, c.tentative_weight);
  c.wheel_share = reader.number("wheel_share", {0.0, 1.0}, c.wheel_share);
  c.strength_doubt = reader.number("strength_doubt", {0.0, 1.0}, c.strength_doubt);
  c.stationary_image_density = reader.number("stationary_image_density", {0.0, 1.0}, c.stationary_image_density);
  c.extent_std_m = reader.number("extent_std_m", {0.1, 10.0}, c.extent_std_m);
  c.range_rate_slack_mps = reader.number("range_rate_slack_mps", {0.0, 10.0}, c.range_rate_slack_mps);
  c.margin_m = reader.number("margin_m", {0.0, 20.0}, c.margin_m);
  c.min_mirror_length_m = reader.number("min_mirror_length_m", {1.0, 100.0}, c.min_mirror_length_m);
  c.mirror_doubt = reader.number("mirror_doubt", {0.0, 1.0}, c.mirror_doubt);
  c.ego_front_m = reader.number("ego_front_m", {0.0, 20.0}, c.ego_front_m);
  c.ego_rear_m = reader.number("ego_rear_m", {-20.0, 0.0}, c.ego_rear_m);
  c.ego_half_width_m = reader.number("ego_half_width_m", {0.1, 3.0}, c.ego_half_width_m);
  return c;
}

MirrorConfig read_mirror(config::Reader root) {
  MirrorConfig c;
  c.tracks_max_age_s = root.number("tracks_max_age_s", {0.05, 10.0}, c.tracks_max_age_s);
  c.map = read_map(root.table("map"));
  c.classes = read_classes(root.table("classes"));
  return c;
}

}  // namespace

Config read_config(config::Reader root) {
  Config c;
  c.method = root.choice<MethodName>("method", {{"mirror", MethodName::kMirror}, {"published", MethodName::kPublished}},
                                     c.method);
  c.mirror = read_mirror(root.table("mirror"));
  c.published = read_published(root.table("published"));
  root.finish();
  return c;
}

}  // namespace boresight::ghosts
