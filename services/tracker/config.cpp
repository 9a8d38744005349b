#include "services/tracker/config.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>

#include "services/common/runtime/config/object_classes_file.hpp"
#include "services/common/runtime/config/read_text.hpp"
#include "services/tracker/core/classes/forest_text.hpp"
#include "services/tracker/core/make_tracker.hpp"

namespace boresight::tracking {

namespace {

/// A number of the configuration: key, value, allowed range.
struct Number {
  std::string_view key;
  double* value;
  config::Range allowed;
};

void read(config::Reader table, std::initializer_list<Number> numbers) {
  for (const Number& n : numbers) *n.value = table.number(n.key, n.allowed, *n.value);
}

/// An array of numbers under one key.
template <std::size_t kSize>
void read_array(config::Reader& table, std::string_view key, config::Range allowed, std::array<double, kSize>& values) {
  const std::vector<double> read = table.numbers(key, kSize, allowed, {values.begin(), values.end()});
  std::copy(read.begin(), read.end(), values.begin());
}

void read_clutter(config::Reader table, ClutterParameters& c) {
  read(table, {{"memory_s", &c.memory_s, {0.1, 100.0}},
               {"table_scans", &c.table_scans, {0.01, 1000.0}},
               {"least_range_rate_mps", &c.least_range_rate_mps, {0.0, 5.0}},
               {"with_ego_factor", &c.with_ego_factor, {0.01, 1000.0}},
               {"pace_mps", &c.pace_mps, {0.01, 10.0}},
               {"pace_over_ground_mps", &c.pace_over_ground_mps, {0.0, 20.0}},
               {"pace_cell_m", &c.pace_cell_m, {1.0, 100.0}},
               {"origin_offset", &c.origin_offset, {-10.0, 10.0}},
               {"origin_weight", &c.origin_weight, {0.0, 2.0}},
               {"origin_limit", &c.origin_limit, {0.0, 20.0}},
               {"level_memory_s", &c.level_memory_s, {0.1, 1000.0}}});
  read_array(table, "table_range_edges_m", {1.0, 1000.0}, c.table_range_edges_m);
  read_array(table, "table_by_range", {1e-12, 1.0}, c.table_by_range);
  read_array(table, "table_rate_edges_mps", {0.1, 200.0}, c.table_rate_edges_mps);
  read_array(table, "table_by_rate", {1e-3, 1e3}, c.table_by_rate);
  const auto increases = [&table](std::string_view key, const auto& edges) {
    if (std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) != edges.end()) {
      table.reject(key, "each edge must be greater than the one before");
    }
  };
  increases("table_range_edges_m", c.table_range_edges_m);
  increases("table_rate_edges_mps", c.table_rate_edges_mps);
  if (c.least_range_rate_mps >= c.table_rate_edges_mps.front()) {
    table.reject("least_range_rate_mps", "must be below the first of table_rate_edges_mps");
  }
}

void read_model(config::Reader& root, RadarModelParameters& m) {
  DetectionParameters& d = m.detection;
  read(root.table("detection"), {{"probability", &d.detection_probability, {0.01, 0.999}},
                                 {"view_edge_rad", &d.view_edge_rad, {0.001, 1.0}},
                                 {"range_edge_m", &d.range_edge_m, {0.01, 50.0}},
                                 {"stationary_sigma", &d.stationary_sigma, {0.1, 20.0}},
                                 {"motion_std_mps", &d.motion_std_mps, {0.0, 5.0}},
                                 {"body_range_rate_std_mps", &d.body_range_rate_std_mps, {0.0, 5.0}},
                                 {"spread", &d.spread, {0.01, 4.0}},
                                 {"held_factor", &d.held_factor, {1.0, 20.0}},
                                 {"count", &d.count, {0.01, 100.0}},
                                 {"count_shape", &d.count_shape, {0.1, 100.0}},
                                 {"count_range_m", &d.count_range_m, {1.0, 300.0}},
                                 {"count_power", &d.count_power, {0.0, 4.0}},
                                 {"count_least", &d.count_least, {0.001, 1.0}},
                                 {"count_most", &d.count_most, {1.0, 100.0}}});
  BirthParameters& b = m.birth;
  read(root.table("birth"), {{"slow_density_per_m2", &b.slow.density_per_m2, {1e-12, 1.0}},
                             {"slow_speed_std_mps", &b.slow.speed_std_mps, {0.1, 100.0}},
                             {"density_per_m2", &b.any.density_per_m2, {1e-12, 1.0}},
                             {"speed_std_mps", &b.any.speed_std_mps, {0.1, 100.0}},
                             {"traffic_density_per_m2", &b.traffic.density_per_m2, {1e-12, 1.0}},
                             {"traffic_speed_std_mps", &b.traffic.speed_std_mps, {0.1, 100.0}},
                             {"half_length_m", &b.half_length_m, {0.1, 10.0}},
                             {"place_std_m", &b.place_std_m, {5.0, 1000.0}},
                             {"extent_dof", &b.extent_dof, {6.5, 100.0}},
                             {"gap_along_m", &b.gap_along_m, {0.0, 10.0}},
                             {"gap_across_m", &b.gap_across_m, {0.0, 5.0}},
                             {"headway_s", &b.headway_s, {0.0, 5.0}},
                             {"close_share", &b.close_share, {1e-3, 1.0}},
                             {"person_m", &b.person_m, {0.05, 5.0}},
                             {"neighbour_density_per_m2", &b.neighbour_density_per_m2, {1e-9, 1.0}},
                             {"company_density_per_m2", &b.company_density_per_m2, {1e-9, 10.0}},
                             {"neighbour_speed_std_mps", &b.neighbour_speed_std_mps, {0.1, 20.0}},
                             {"part_odds", &b.part_odds, {1e-3, 1e6}},
                             {"same_speed_chi2", &b.same_speed_chi2, {0.1, 100.0}},
                             {"link_distance_m", &b.link_distance_m, {0.1, 20.0}},
                             {"link_range_rate_mps", &b.link_range_rate_mps, {0.01, 20.0}}});
  read_clutter(root.table("clutter"), m.clutter);
  SourceParameters& s = m.source;
  read(root.table("source"), {{"share", &s.share, {0.0, 1.0}},
                              {"life_s", &s.life_s, {0.01, 10.0}},
                              {"wander_m", &s.wander_m, {0.0, 20.0}},
                              {"more", &s.more, {0.01, 0.99}},
                              {"lasting_share", &s.lasting_share, {0.0, 1.0}},
                              {"other_radar", &s.other_radar, {0.001, 1.0}},
                              {"side_lobes", &s.side_lobes, {0.0, 100.0}},
                              {"parent_existence", &s.parent_existence, {0.0, 1.0}},
                              {"side_lobe_range_std_m", &s.side_lobe_range_std_m, {0.01, 20.0}},
                              {"side_lobe_range_rate_std_mps", &s.side_lobe_range_rate_std_mps, {0.01, 10.0}},
                              {"side_lobe_nearest_m", &s.side_lobe_nearest_m, {0.1, 20.0}},
                              {"side_lobe_chi2", &s.side_lobe_chi2, {0.1, 100.0}},
                              {"main_lobe_rad", &s.main_lobe_rad, {0.0, 0.5}},
                              {"side_lobe_least_deviations", &s.side_lobe_least_deviations, {0.0, 20.0}},
                              {"ambiguity_share", &s.ambiguity_share, {0.0, 1.0}},
                              {"ambiguity_width_mps", &s.ambiguity_width_mps, {1.0, 1000.0}},
                              {"wide_chi2", &s.wide_chi2, {0.1, 100.0}},
                              {"wide_prior", &s.wide_prior, {0.01, 1000.0}},
                              {"side_lobe_birth", &s.side_lobe_birth, {0.0, 1.0}},
                              {"side_lobe_shape", &s.side_lobe_shape, {0.01, 100.0}},
                              {"side_lobe_strength_db", &s.side_lobe_strength_db, {-100.0, 100.0}},
                              {"side_lobe_strength_std_db", &s.side_lobe_strength_std_db, {0.1, 1000.0}},
                              {"object_strength_std_db", &s.object_strength_std_db, {0.1, 1000.0}},
                              {"strength_std_db", &s.strength_std_db, {0.1, 1000.0}},
                              {"strength_memory_s", &s.strength_memory_s, {0.05, 1000.0}}});
  MotionParameters& k = m.motion;
  read(root.table("motion"), {{"acceleration_density_m2ps3", &k.acceleration_density, {1e-4, 100.0}},
                              {"rate_memory_s", &k.rate_memory_s, {0.05, 100.0}},
                              {"rate_min_shape", &k.rate_min_shape, {0.0, 10.0}},
                              {"extent_memory_s", &k.extent_memory_s, {0.05, 100.0}},
                              {"extent_min_dof", &k.extent_min_dof, {6.5, 20.0}},
                              {"extent_min_m2", &k.extent_min_m2, {1e-6, 1.0}},
                              {"object_life_s", &m.object_life_s, {0.1, 1000.0}},
                              {"longest_gap_s", &m.longest_gap_s, {0.1, 100.0}},
                              {"latest_scan_s", &m.latest_scan_s, {0.0, 10.0}}});
}

std::uint32_t read_work_budget(config::Reader& table, std::uint32_t usual) {
  return static_cast<std::uint32_t>(table.integer("work_budget", {100, 1e8}, static_cast<std::int64_t>(usual)));
}

// min_poisson_weight and birth_merge_distance have no effect on radars: births are everywhere.
void read_search(config::Reader table, pmbm::Parameters& p) {
  read(table, {{"gate_chi2", &p.gate_chi2, {1.0, 100.0}},
               {"cell_gate_chi2", &p.cell_gate_chi2, {1.0, 100.0}},
               {"prune_weight", &p.prune_weight, {1e-9, 0.1}},
               {"candidate_log", &p.candidate_log, {0.0, 30.0}},
               {"search_log", &p.search_log, {0.0, 30.0}},
               {"merge_distance", &p.merge_distance, {0.0, 100.0}},
               {"join_existence", &p.join_existence, {0.01, 0.999}},
               {"min_existence", &p.min_existence, {1e-6, 0.5}},
               {"min_detection_probability", &p.min_detection_probability, {1e-9, 0.5}},
               {"min_share", &p.min_share, {1e-9, 0.5}},
               {"first_cell_links", &p.first_cell_links, {0.0, 10.0}},
               {"report_existence", &p.report_existence, {1e-6, 0.5}}});
  p.sharing_passes = static_cast<int>(table.integer("sharing_passes", {1, 20}, p.sharing_passes));
  p.work_budget = read_work_budget(table, p.work_budget);
}

void read_phd(config::Reader table, phd::Parameters& p) {
  read(table, {{"gate_chi2", &p.gate_chi2, {1.0, 100.0}},
               {"prune_weight", &p.prune_weight, {1e-9, 0.5}},
               {"merge_distance", &p.merge_distance, {0.0, 100.0}},
               {"min_detection_probability", &p.min_detection_probability, {1e-9, 0.5}},
               {"min_share", &p.min_share, {1e-9, 0.5}},
               {"least_entropy", &p.least_entropy, {0.0, 10.0}},
               {"least_cell", &p.least_cell, {0.01, 2.0}},
               {"object_probability", &p.object_probability, {0.01, 0.99}},
               {"report_existence", &p.report_existence, {1e-6, 0.5}}});
  p.work_budget = read_work_budget(table, p.work_budget);
}

/// One number for each class.
template <std::size_t kSize>
void read_counts(config::Reader& table, std::string_view key, config::Range allowed, std::array<int, kSize>& values) {
  std::array<double, kSize> numbers{};
  std::copy(values.begin(), values.end(), numbers.begin());
  read_array(table, key, allowed, numbers);
  for (std::size_t k = 0; k < kSize; ++k) {
    values[k] = static_cast<int>(numbers[k]);
    if (static_cast<double>(values[k]) != numbers[k]) table.reject(key, "must be whole numbers");
  }
}

void read_classical(config::Reader table, classical::Parameters& p) {
  std::vector<std::pair<std::string_view, filters::FilterKind>> kinds;
  for (const std::string_view name : filters::filter_kind_names())
    kinds.emplace_back(name, *filters::filter_kind(name));
  p.filter = table.choice("filter", kinds, p.filter);
  using classical::ShapeCriterion;
  p.heading.shape.criterion =
      table.choice("shape_criterion",
                   std::vector<std::pair<std::string_view, ShapeCriterion>>{{"area", ShapeCriterion::kArea},
                                                                            {"closeness", ShapeCriterion::kCloseness},
                                                                            {"variance", ShapeCriterion::kVariance}},
                   p.heading.shape.criterion);
  read(table, {{"cluster_radius_m", &p.cluster.radius_m, {0.1, 20.0}},
               {"cluster_range_rate_gap_mps", &p.cluster.range_rate_gap_mps, {0.01, 20.0}},
               {"cluster_least_weight", &p.cluster.least_weight, {0.0, 100.0}},
               {"gate_place_chi2", &p.gate.place_chi2, {1.0, 100.0}},
               {"gate_range_rate_chi2", &p.gate.range_rate_chi2, {1.0, 100.0}},
               {"start_strength_db", &p.start.strength_db, {-200.0, 100.0}},
               {"start_existence", &p.start.existence, {1e-6, 0.5}},
               {"least_detection_probability", &p.life.least_detection_probability, {0.01, 0.99}},
               {"least_existence", &p.life.least_existence, {1e-6, 0.5}},
               {"first_acceleration_std_mps2", &p.motion.first_acceleration_std_mps2, {0.01, 20.0}},
               {"history_s", &p.heading.history_s, {0.01, 5.0}},
               {"known_std_rad", &p.heading.known_std_rad, {0.01, 1.0}},
               {"doppler_least_speed_mps", &p.heading.doppler.least_speed_mps, {0.1, 20.0}},
               {"doppler_interval_rad", &p.heading.doppler.interval_rad, {0.1, 1.5}},
               {"doppler_outlier_chi2", &p.heading.doppler.outlier_chi2, {1.0, 100.0}},
               {"shape_face_std_m", &p.heading.shape.face_std_m, {0.01, 5.0}},
               {"shape_nearest_m", &p.heading.shape.nearest_m, {0.001, 2.0}},
               {"join_existence", &p.join_existence, {0.01, 0.999}},
               {"report_existence", &p.report_existence, {1e-6, 0.5}}});
  const auto points = [&table](std::string_view key, config::Range allowed, auto& value) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(
        table.integer(key, allowed, static_cast<std::int64_t>(value)));
  };
  constexpr auto kHistory = static_cast<double>(classical::History::kCapacity);
  points("start_points", {1, 100}, p.start.points);
  points("doppler_least_points", {3, kHistory}, p.heading.doppler.least_points);
  points("shape_least_points", {5, kHistory}, p.heading.shape.least_points);
  constexpr config::Range kLooks{1.0, classical::Looks::kMost};
  read_counts(table, "confirm_hits", kLooks, p.life.confirm_hits);
  read_counts(table, "confirm_looks", kLooks, p.life.confirm_looks);
  read_counts(table, "delete_misses", kLooks, p.life.delete_misses);
  read_counts(table, "delete_looks", kLooks, p.life.delete_looks);
  read_array(table, "coast_s", {0.01, 100.0}, p.life.coast_s);
  read_array(table, "jerk_density_m2ps5", {1e-6, 1e3}, p.motion.jerk_density_m2ps5);
  read_array(table, "acceleration_time_s", {0.01, 100.0}, p.motion.acceleration_time_s);
  for (std::size_t k = 0; k < p.life.confirm_hits.size(); ++k) {
    if (p.life.confirm_hits[k] > p.life.confirm_looks[k]) {
      table.reject("confirm_hits", "must not exceed confirm_looks");
    }
    if (p.life.delete_misses[k] > p.life.delete_looks[k]) {
      table.reject("delete_misses", "must not exceed delete_looks");
    }
  }
}

void read_capacity(config::Reader table, pmbm::Capacity& c) {
  const auto capacity = [&table](std::string_view key, config::Range allowed, std::size_t& value) {
    value = static_cast<std::size_t>(table.integer(key, allowed, static_cast<std::int64_t>(value)));
  };
  capacity("measurements", {16, 1024}, c.measurements);
  capacity("objects", {16, 4096}, c.objects);
  capacity("local_hypotheses", {64, 30000}, c.local_hypotheses);
  capacity("group_objects", {4, 256}, c.group_objects);
  capacity("group_measurements", {16, 1024}, c.group_measurements);
  capacity("rows", {1, 64}, c.rows);
  capacity("candidates", {1, 256}, c.candidates);
  if (c.group_objects > c.objects) table.reject("group_objects", "must not exceed objects");
  if (c.group_measurements > c.measurements) table.reject("group_measurements", "must not exceed measurements");
}

void read_surroundings(config::Reader& root, SurroundingsParameters& p) {
  StationaryParameters& s = p.stationary;
  config::Reader stationary = root.table("surroundings");
  read(stationary, {{"memory_s", &s.memory_s, {0.05, 5.0}},
                    {"least_probability", &s.least_probability, {0.0, 1.0}},
                    {"behind_m", &s.behind_m, {0.0, 50.0}},
                    {"ahead_m", &s.ahead_m, {10.0, 150.0}},
                    {"aside_m", &s.aside_m, {2.0, 50.0}},
                    {"lowest_m", &s.lowest_m, {-5.0, 5.0}},
                    {"highest_m", &s.highest_m, {0.5, 10.0}},
                    {"mounting_std_rad", &s.mounting_std_rad, {0.0, 0.1}}});
  s.scans_per_look = static_cast<int>(stationary.integer("scans_per_look", {1, 100}, s.scans_per_look));
  RoadEdgeParameters& e = p.road_edge;
  read(root.table("road_edge"), {{"gate_sigma", &e.gate_sigma, {1.0, 10.0}},
                                 {"ahead_m", &e.ahead_m, {10.0, 150.0}},
                                 {"band_half_width_m", &e.band_half_width_m, {0.05, 2.0}},
                                 {"cell_m", &e.cell_m, {2.0, 10.0}},
                                 {"contrast_probability", &e.contrast_probability, {0.34, 0.999}},
                                 {"cell_memory_s", &e.cell_memory_s, {0.05, 20.0}},
                                 {"least_cell_detections", &e.least_cell_detections, {1.0, 1000.0}},
                                 {"prior_log_odds", &e.prior_log_odds, {-50.0, 0.0}},
                                 {"start_log_odds", &e.start_log_odds, {-10.0, 50.0}},
                                 {"end_log_odds", &e.end_log_odds, {-50.0, 50.0}},
                                 {"slope_step", &e.slope_step, {0.001, 0.2}},
                                 {"curvature_step_per_m", &e.curvature_step_per_m, {1e-05, 0.05}},
                                 {"least_distance_m", &e.least_distance_m, {0.1, 10.0}},
                                 {"separation_m", &e.separation_m, {0.1, 10.0}},
                                 {"longest_gap_m", &e.longest_gap_m, {0.0, 50.0}},
                                 {"longest_coast_s", &e.longest_coast_s, {0.05, 20.0}},
                                 {"scatter_m", &e.scatter_m, {0.001, 1.0}},
                                 {"scatter_memory_s", &e.scatter_memory_s, {0.05, 100.0}},
                                 {"least_weight", &e.least_weight, {0.0, 0.5}},
                                 {"repeat_factor", &e.repeat_factor, {1.0, 1000.0}},
                                 {"offset_density_m2pm", &e.offset_density_m2pm, {0.0, 1.0}},
                                 {"slope_density_pm", &e.slope_density_pm, {0.0, 0.01}},
                                 {"curvature_density_pm3", &e.curvature_density_pm3, {0.0, 0.001}},
                                 {"curvature_rate_std_pm2", &e.curvature_rate_std_pm2, {0.0, 0.01}},
                                 {"report_existence", &e.report_existence, {0.0, 1.0}},
                                 {"course_existence", &e.course_existence, {0.0, 1.0}},
                                 {"course_beyond_m", &e.course_beyond_m, {0.0, 100.0}}});
  ObstacleParameters& o = p.obstacle;
  config::Reader obstacle = root.table("path_obstacle");
  read(obstacle, {{"corridor_m", &o.corridor_m, {0.5, 10.0}},
                  {"cluster_radius_m", &o.cluster_radius_m, {0.1, 10.0}},
                  {"least_detections", &o.least_detections, {1.0, 500.0}},
                  {"gate_m", &o.gate_m, {0.1, 10.0}},
                  {"count", &o.count, {0.01, 100.0}},
                  {"count_range_m", &o.count_range_m, {1.0, 300.0}},
                  {"count_power", &o.count_power, {0.0, 4.0}},
                  {"background_count", &o.background_count, {0.001, 10.0}},
                  {"background_factor", &o.background_factor, {0.0, 100.0}},
                  {"background_memory_s", &o.background_memory_s, {0.1, 100.0}},
                  {"excess_db", &o.excess_db, {0.0, 60.0}},
                  {"excess_std_db", &o.excess_std_db, {1.0, 60.0}},
                  {"level_memory_s", &o.level_memory_s, {0.1, 1000.0}},
                  {"level_range_m", &o.level_range_m, {5.0, 100.0}},
                  {"most_of_scan", &o.most_of_scan, {0.1, 100.0}},
                  {"evidence_share", &o.evidence_share, {0.001, 1.0}},
                  {"prior_log_odds", &o.prior_log_odds, {-50.0, 0.0}},
                  {"most_log_odds", &o.most_log_odds, {0.0, 50.0}},
                  {"end_log_odds", &o.end_log_odds, {-50.0, 50.0}},
                  {"position_density_m2ps", &o.position_density_m2ps, {0.0, 10.0}},
                  {"centre_std_m", &o.centre_std_m, {0.01, 5.0}},
                  {"extent_memory_s", &o.extent_memory_s, {0.05, 20.0}},
                  {"life_s", &o.life_s, {0.05, 20.0}}});
  o.looks_per_search = static_cast<int>(obstacle.integer("looks_per_search", {1, 100}, o.looks_per_search));
  CollisionParameters& c = p.collision;
  read(root.table("collision"), {{"front_m", &c.front_m, {0.1, 20.0}},
                                 {"width_m", &c.width_m, {0.5, 4.0}},
                                 {"lateral_jerk_density_m2ps5", &c.lateral_jerk_density_m2ps5, {0.0, 100.0}},
                                 {"road_share", &c.road_share, {0.0, 1.0}},
                                 {"lane_std_m", &c.lane_std_m, {0.001, 5.0}},
                                 {"least_speed_mps", &c.least_speed_mps, {0.1, 20.0}},
                                 {"horizon_s", &c.horizon_s, {0.5, 20.0}},
                                 {"warning_time_s", &c.warning_time_s, {0.1, 20.0}},
                                 {"warning_probability", &c.warning_probability, {0.01, 0.999}},
                                 {"oncoming_probability", &c.oncoming_probability, {0.01, 1.0}},
                                 {"oncoming_speed_mps", &c.oncoming_speed_mps, {0.0, 50.0}},
                                 {"warning_deceleration_mps2", &c.warning_deceleration_mps2, {0.0, 20.0}},
                                 {"warning_lateral_mps2", &c.warning_lateral_mps2, {-20.0, 20.0}},
                                 {"hold_s", &c.hold_s, {0.0, 5.0}},
                                 {"obstacle_hold_s", &c.obstacle_hold_s, {0.0, 5.0}},
                                 {"least_existence", &c.least_existence, {0.0, 1.0}},
                                 {"report_probability", &c.report_probability, {0.0, 1.0}}});
}

}  // namespace

Config read_config(config::Reader root) {
  Config c;
  std::vector<std::pair<std::string_view, std::string>> names;
  const std::vector<std::string> known = tracker_names();
  for (const std::string& name : known) names.emplace_back(name, name);
  c.tracker = root.choice("tracker", names, c.tracker);
  read_model(root, c.model);
  read_search(root.table("search"), c.pmbm);
  read_phd(root.table("phd"), c.phd);
  read_classical(root.table("classical"), c.classical);
  read_capacity(root.table("capacity"), c.capacity);
  BoxParameters& x = c.model.box;
  read(root.table("box"), {{"evidence_share", &x.evidence_share, {0.0, 1.0}},
                           {"stray_share", &x.stray_share, {0.0, 0.99}},
                           {"stray_m", &x.stray_m, {0.1, 20.0}},
                           {"forget_s", &x.forget_s, {0.1, 1e4}},
                           {"side_slip_mps", &x.side_slip_mps, {0.0, 5.0}},
                           {"lateral_acceleration_mps2", &x.turn.lateral_acceleration_mps2, {0.01, 20.0}},
                           {"turn_radius_m", &x.turn.radius_m, {0.1, 100.0}},
                           {"turn_time_s", &x.turn.time_s, {0.0, 10.0}},
                           {"parallel_share", &x.road.parallel_share, {0.0, 0.5}},
                           {"parallel_std_rad", &x.road.parallel_std_rad, {0.001, 3.0}},
                           {"parallel_prior_s", &x.road.prior_s, {0.001, 1e6}},
                           {"parallel_memory_s", &x.road.memory_s, {0.1, 1e6}},
                           {"known_heading_rad", &x.known_heading_rad, {0.01, 3.0}},
                           {"contradiction_chi2", &x.contradiction_chi2, {0.1, 100.0}},
                           {"sure_speed_sigma", &x.sure_speed_sigma, {0.0, 10.0}},
                           {"least_length_share", &x.least_length_share, {0.01, 1.0}},
                           {"least_doubt", &x.least_doubt, {1e-9, 0.5}},
                           {"least_probability", &x.least_probability, {1e-6, 0.1}}});
  ReportParameters& r = c.report;
  config::Reader report = root.table("report");
  read(report, {{"confirmed_existence", &r.confirmed_existence, {0.01, 0.999999}},
                {"hold_log_odds_per_s", &r.hold_log_odds_per_s, {0.0, 1e6}},
                {"least_existence", &r.least_existence, {0.001, 0.5}},
                {"stopped_speed_mps", &r.stopped_speed_mps, {0.0, 5.0}},
                {"flag_probability", &r.flags.likely, {0.01, 0.99}},
                {"merged_share", &r.flags.merged_share, {0.01, 1.0}},
                {"recent_scan_s", &r.flags.recent_scan_s, {0.01, 10.0}}});
  if (r.confirmed_existence <= r.least_existence) {
    report.reject("confirmed_existence", "must be greater than least_existence");
  }
  read_surroundings(root, c.surroundings);
  root.finish();
  return c;
}

std::filesystem::path forest_file(const runtime::Configuration& files) {
  return files.directory / "services" / "object_forest.csv";
}

ObjectForest read_forest(const std::filesystem::path& file) {
  try {
    return parse_forest(config::read_text(file));
  } catch (const ForestTextError& error) {
    throw config::Error(fmt::format("{}:{}: {}", file.string(), error.line, error.what()));
  }
}

Config read_config(const runtime::Configuration& files) {
  Config c = read_config(config::Reader::open(files.service_file("tracker")));
  c.model.classes = config::read_object_classes(config::Reader::open(files.service_file("object_classes")));
  c.forest = read_forest(forest_file(files));
  return c;
}

}  // namespace boresight::tracking
