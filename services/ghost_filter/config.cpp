#include "services/ghost_filter/config.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "services/ghost_filter/weights_file.hpp"

namespace boresight::ghosts {

namespace {

/// Largest budget of a search.
constexpr double kMostLooks = 1e5;

std::size_t read_count(config::Reader& reader, std::string_view key, std::size_t fallback, double most = 1000.0) {
  return static_cast<std::size_t>(reader.integer(key, {1, most}, static_cast<std::int64_t>(fallback)));
}

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
  c.cluster_min_points = read_count(reflectors, "cluster_min_points", c.cluster_min_points);
  c.min_segment_points = read_count(reflectors, "min_segment_points", c.min_segment_points);
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
  c.least_new_share = reader.number("least_new_share", {0.0, 1.0}, c.least_new_share);
  c.search_period_s = reader.number("search_period_s", {0.0, 5.0}, c.search_period_s);
  c.most_std_m = reader.number("most_std_m", {0.05, 10.0}, c.most_std_m);
  c.most_points = read_count(reader, "most_points", c.most_points, kMostLooks);
  LineConfig& l = c.lines;
  l.cell_m = reader.number("cell_m", {0.1, 5.0}, l.cell_m);
  l.draws = read_count(reader, "draws", l.draws);
  l.tolerance_m = reader.number("tolerance_m", {0.02, 3.0}, l.tolerance_m);
  l.max_gap_m = reader.number("max_gap_m", {0.5, 50.0}, l.max_gap_m);
  l.min_cells = read_count(reader, "min_cells", l.min_cells);
  l.min_length_m = reader.number("min_length_m", {0.5, 100.0}, l.min_length_m);
  l.beside_m = reader.number("beside_m", {0.02, 20.0}, l.beside_m);
  l.min_purity = reader.number("min_purity", {0.0, 1.0}, l.min_purity);
  l.most_lines = read_count(reader, "most_lines", l.most_lines);
  return c;
}

CountConfig read_counts(config::Reader reader) {
  CountConfig c;
  c.memory_s = reader.number("memory_s", {0.0, 2.0}, c.memory_s);
  c.past_radius_m = reader.number("past_radius_m", {0.1, 20.0}, c.past_radius_m);
  c.past_radius_per_range = reader.number("past_radius_per_range", {0.0, 0.2}, c.past_radius_per_range);
  c.past_range_rate_mps = reader.number("past_range_rate_mps", {0.05, 10.0}, c.past_range_rate_mps);
  c.company_radius_m = reader.number("company_radius_m", {0.1, 20.0}, c.company_radius_m);
  c.company_range_rate_mps = reader.number("company_range_rate_mps", {0.05, 10.0}, c.company_range_rate_mps);
  c.wide_range_m = reader.number("wide_range_m", {0.1, 50.0}, c.wide_range_m);
  c.wide_range_rate_mps = reader.number("wide_range_rate_mps", {0.05, 20.0}, c.wide_range_rate_mps);
  c.most_neighbours = read_count(reader, "most_neighbours", c.most_neighbours, kMostLooks);
  c.most_past_looks = read_count(reader, "most_past_looks", c.most_past_looks, kMostLooks);
  c.most_remembered = read_count(reader, "most_remembered", c.most_remembered, kMostLooks);
  return c;
}

/// Edges in strict order: rising, or falling.
template <std::size_t N>
void read_edges(config::Reader& reader, std::string_view key, bool rises, std::array<double, N>& edges) {
  const std::vector<double> read = reader.numbers(key, N, {-20.0, 1e6}, {edges.begin(), edges.end()});
  for (std::size_t i = 1; i < N; ++i) {
    if (rises ? read[i] > read[i - 1] : read[i] < read[i - 1]) continue;
    reader.reject(key, rises ? "must rise" : "must fall");
    return;
  }
  std::copy_n(read.begin(), N, edges.begin());
}

LevelConfig read_levels(config::Reader reader) {
  LevelConfig c;
  read_edges(reader, "past_scans", true, c.past_scans);
  read_edges(reader, "company", true, c.company);
  read_edges(reader, "ring_share", false, c.ring_share);
  read_edges(reader, "range_m", true, c.range_m);
  read_edges(reader, "wide_ring", true, c.wide_ring);
  read_edges(reader, "burst", true, c.burst);
  read_edges(reader, "existence", true, c.existence);
  read_edges(reader, "image_share", true, c.image_share);
  read_edges(reader, "track_log10_intensity", true, c.track_log10_intensity);
  return c;
}

IntensityConfig read_intensity(config::Reader reader) {
  IntensityConfig c;
  c.ambiguous_share = reader.number("ambiguous_share", {0.0, 0.5}, c.ambiguous_share);
  c.ambiguous_width_mps = reader.number("ambiguous_width_mps", {1.0, 500.0}, c.ambiguous_width_mps);
  c.position_std_m = reader.number("position_std_m", {0.01, 10.0}, c.position_std_m);
  c.velocity_std_mps = reader.number("velocity_std_mps", {0.01, 10.0}, c.velocity_std_mps);
  c.other_intensity = reader.number("other_intensity", {1e-9, 1.0}, c.other_intensity);
  c.certainty_power = reader.number("certainty_power", {0.1, 20.0}, c.certainty_power);
  c.mirrored_existence = reader.number("mirrored_existence", {0.0, 1.0}, c.mirrored_existence);
  c.mirror_share_per_m = reader.number("mirror_share_per_m", {0.0, 1.0}, c.mirror_share_per_m);
  c.most_mirror_share = reader.number("most_mirror_share", {0.0, 1.0}, c.most_mirror_share);
  c.least_mirror_share = reader.number("least_mirror_share", {0.0, 1.0}, c.least_mirror_share);
  c.mirror_scatter_m = reader.number("mirror_scatter_m", {0.001, 5.0}, c.mirror_scatter_m);
  if (c.least_mirror_share > c.most_mirror_share) {
    reader.reject("least_mirror_share", "must not exceed most_mirror_share");
  }
  return c;
}

EvidenceConfig read_evidence(config::Reader root) {
  EvidenceConfig c;
  c.tracks_max_age_s = root.number("tracks_max_age_s", {0.05, 10.0}, c.tracks_max_age_s);
  c.counts = read_counts(root.table("counts"));
  c.levels = read_levels(root.table("levels"));
  c.intensity = read_intensity(root.table("intensity"));
  c.map = read_map(root.table("map"));
  return c;
}

}  // namespace

Config read_settings(config::Reader root) {
  Config c;
  c.method = root.choice<MethodName>(
      "method", {{"evidence", MethodName::kEvidence}, {"published", MethodName::kPublished}}, c.method);
  c.evidence = read_evidence(root.table("evidence"));
  c.published = read_published(root.table("published"));
  root.finish();
  return c;
}

Config read_config(const runtime::Configuration& files, const VehicleConfig& vehicle) {
  Config c = read_settings(config::Reader::open(files.service_file("ghost_filter")));
  for (const RadarConfig& radar : vehicle.radars) {
    c.evidence.radars.push_back({radar.id, read_weights(files.radar_profile_file(radar.statistics))});
  }
  return c;
}

}  // namespace boresight::ghosts
