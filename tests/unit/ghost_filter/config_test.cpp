// The shipped file: every key, with the default's value.
#include "services/ghost_filter/config.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/unit/shipped_config.hpp"

namespace boresight::ghosts {
namespace {

const std::filesystem::path kShipped =
    std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/ghost_filter.toml";

std::vector<double> numbers(const Config& config) {
  const published::Config& c = config.published;
  const MapConfig& m = config.mirror.map;
  const ClassConfig& k = config.mirror.classes;
  return {c.max_range_rate_mps,
          c.min_expected_range_rate_mps,
          c.memory_s,
          c.update_period_s,
          c.cell_m,
          c.cluster_length_m,
          c.cluster_width_m,
          static_cast<double>(c.cluster_min_points),
          c.min_segment_length_m,
          static_cast<double>(c.min_segment_points),
          c.max_segment_residual_m,
          c.type2_margin_m,
          c.type1_margin_m,
          c.ellipse_margin_m,
          c.tracks_max_age_s,
          config.mirror.tracks_max_age_s,
          m.memory_s,
          m.update_period_s,
          m.search_period_s,
          m.cell_m,
          m.cluster_radius_m,
          static_cast<double>(m.cluster_min_cells),
          m.tolerance_m,
          static_cast<double>(m.min_cells),
          m.min_length_m,
          m.max_gap_m,
          m.min_purity,
          m.max_curvature_per_m,
          m.bin_m,
          k.decision_probability,
          k.memory_s,
          k.sighting_s,
          k.new_object_density,
          k.clutter_density,
          k.lone_ghost_density,
          k.hidden_ghost_density,
          k.type1_per_object,
          k.type1_unheard,
          k.type2_per_object,
          k.real_per_object,
          k.real_per_truck,
          k.tentative_weight,
          k.wheel_share,
          k.strength_doubt,
          k.stationary_image_density,
          k.extent_std_m,
          k.range_rate_slack_mps,
          k.margin_m,
          k.min_mirror_length_m,
          k.mirror_doubt,
          k.ego_front_m,
          k.ego_rear_m,
          k.ego_half_width_m};
}

TEST(GhostFilterConfig, TheShippedFileHasTheDefaults) {
  const Config read = read_config(config::Reader::open(kShipped));
  EXPECT_EQ(read.method, Config{}.method);
  EXPECT_EQ(numbers(read), numbers(Config{}));
}

TEST(GhostFilterConfig, EveryKeyIsReadIntoItsPlace) {
  const auto read = [](const std::string& text) { return numbers(read_config(config::Reader::parse(text, "x.toml"))); };
  EXPECT_EQ(test::expect_each_number_is_read(kShipped, read), numbers(Config{}).size());
}

TEST(GhostFilterConfig, AMethodThatIsNoneIsRefused) {
  EXPECT_THROW(static_cast<void>(read_config(config::Reader::parse("method = \"magic\"", "x.toml"))), config::Error);
}

}  // namespace
}  // namespace boresight::ghosts
