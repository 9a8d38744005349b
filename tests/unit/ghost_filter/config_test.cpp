// The shipped file: every key, with the default's value.
#include "services/ghost_filter/config.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "services/ghost_filter/weights_file.hpp"
#include "tests/unit/schema_page.hpp"
#include "tests/unit/shipped_config.hpp"

namespace boresight::ghosts {
namespace {

const std::filesystem::path kShipped =
    std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/ghost_filter.toml";

/// Settings that are one number each; the edges of the levels are lists.
std::vector<double> numbers(const Config& config) {
  const published::Config& p = config.published;
  const EvidenceConfig& e = config.evidence;
  const CountConfig& c = e.counts;
  const IntensityConfig& i = e.intensity;
  const MapConfig& m = e.map;
  const LineConfig& l = m.lines;
  return {p.max_range_rate_mps,
          p.min_expected_range_rate_mps,
          p.memory_s,
          p.update_period_s,
          p.cell_m,
          p.cluster_length_m,
          p.cluster_width_m,
          static_cast<double>(p.cluster_min_points),
          p.min_segment_length_m,
          static_cast<double>(p.min_segment_points),
          p.max_segment_residual_m,
          p.type2_margin_m,
          p.type1_margin_m,
          p.ellipse_margin_m,
          p.tracks_max_age_s,
          e.tracks_max_age_s,
          c.memory_s,
          c.past_radius_m,
          c.past_radius_per_range,
          c.past_range_rate_mps,
          c.company_radius_m,
          c.company_range_rate_mps,
          c.wide_range_m,
          c.wide_range_rate_mps,
          static_cast<double>(c.most_neighbours),
          static_cast<double>(c.most_past_looks),
          static_cast<double>(c.most_remembered),
          i.ambiguous_share,
          i.ambiguous_width_mps,
          i.position_std_m,
          i.velocity_std_mps,
          i.other_intensity,
          i.certainty_power,
          i.mirrored_existence,
          i.mirror_share_per_m,
          i.most_mirror_share,
          i.least_mirror_share,
          i.mirror_scatter_m,
          m.memory_s,
          m.search_period_s,
          m.least_new_share,
          m.most_std_m,
          static_cast<double>(m.most_points),
          l.cell_m,
          static_cast<double>(l.draws),
          l.tolerance_m,
          l.max_gap_m,
          static_cast<double>(l.min_cells),
          l.min_length_m,
          l.beside_m,
          l.min_purity,
          static_cast<double>(l.most_lines)};
}

/// The edges of each piece of evidence, by their key.
std::map<std::string, std::vector<double>> edges(const Config& config) {
  const LevelConfig& l = config.evidence.levels;
  const auto list = [](const auto& array) { return std::vector<double>(array.begin(), array.end()); };
  return {{"past_scans", list(l.past_scans)},
          {"company", list(l.company)},
          {"ring_share", list(l.ring_share)},
          {"range_m", list(l.range_m)},
          {"wide_ring", list(l.wide_ring)},
          {"burst", list(l.burst)},
          {"existence", list(l.existence)},
          {"image_share", list(l.image_share)},
          {"track_log10_intensity", list(l.track_log10_intensity)}};
}

Config parsed(const std::string& text) {
  return read_settings(config::Reader::parse(text, "x.toml"));
}

TEST(GhostFilterConfig, TheShippedFileHasTheDefaults) {
  const Config read = read_settings(config::Reader::open(kShipped));
  EXPECT_EQ(read.method, Config{}.method);
  EXPECT_EQ(numbers(read), numbers(Config{}));
  EXPECT_EQ(edges(read), edges(Config{}));
}

TEST(GhostFilterConfig, EveryKeyIsReadIntoItsPlace) {
  const auto read = [](const std::string& text) { return numbers(parsed(text)); };
  EXPECT_EQ(test::expect_each_number_is_read(kShipped, read), numbers(Config{}).size());
}

TEST(GhostFilterConfig, EveryListOfEdgesIsReadIntoItsPlace) {
  const std::string shipped = schema_page::text_of(kShipped.string());
  const auto usual = edges(Config{});
  for (const auto& [key, values] : usual) {
    ASSERT_NE(shipped.find("\n" + key + " = ["), std::string::npos) << key;
    auto expected = usual;
    std::string text;
    for (double& value : expected[key]) {
      value = std::stod(std::to_string(1.5 * value));
      text += (text.empty() ? "" : ", ") + std::to_string(value);
    }
    EXPECT_EQ(edges(parsed("[evidence.levels]\n" + key + " = [" + text + "]")), expected) << key;
  }
}

TEST(GhostFilterConfig, EdgesOutOfOrderAreRefused) {
  for (const char* wrong : {"past_scans = [1, 2, 2, 5, 7]", "ring_share = [0.3, 0.5]", "burst = [8, 20]",
                            "track_log10_intensity = [-2, -3, -4.5, -6]", "existence = [0.25, 0.5, \"much\"]"}) {
    EXPECT_THROW(static_cast<void>(parsed(std::string("[evidence.levels]\n") + wrong)), config::Error) << wrong;
  }
}

TEST(GhostFilterConfig, TheWeightsAreThoseOfEachRadarsProfile) {
  const std::filesystem::path folder = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config";
  runtime::Configuration files;
  files.directory = folder;
  VehicleConfig vehicle;
  for (const auto& [id, statistics] : {std::pair(7U, "ideal"), std::pair(3U, "can_cluster")}) {
    RadarConfig radar;
    radar.id = id;
    radar.statistics = statistics;
    vehicle.radars.push_back(radar);
  }
  const Config config = read_config(files, vehicle);
  ASSERT_EQ(config.evidence.radars.size(), 2U);
  EXPECT_EQ(config.evidence.radars[0].radar_id, 7U);
  EXPECT_EQ(config.evidence.radars[0].weights.alone.of, read_weights(folder / "radar_profiles/ideal.toml").alone.of);
  EXPECT_EQ(config.evidence.radars[1].radar_id, 3U);
  EXPECT_EQ(config.evidence.radars[1].weights.alone.of,
            read_weights(folder / "radar_profiles/can_cluster.toml").alone.of);
  vehicle.radars[1].statistics = "none_such";
  EXPECT_THROW(static_cast<void>(read_config(files, vehicle)), config::Error);
}

TEST(GhostFilterConfig, AMethodThatIsNoneIsRefused) {
  EXPECT_THROW(static_cast<void>(parsed("method = \"magic\"")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("method = \"mirror\"")), config::Error);
}

}  // namespace
}  // namespace boresight::ghosts
