// The shipped file: every key, with the default's value.
#include "services/ghost_filter/config.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

std::string shipped() {
  const std::ifstream file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/ghost_filter.toml");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<double> numbers(const published::Config& c) {
  return {c.memory_s,
          c.update_period_s,
          c.cell_m,
          c.cluster_radius_m,
          static_cast<double>(c.cluster_min_points),
          c.min_segment_length_m,
          static_cast<double>(c.min_segment_points),
          c.max_segment_residual_m,
          c.type2_margin_m,
          c.type1_margin_m,
          c.ellipse_margin_m,
          c.tracks_max_age_s};
}

TEST(GhostFilterConfig, TheShippedFileHasTheDefaults) {
  const Config read = read_config(config::Reader::parse(shipped(), "ghost_filter.toml"));
  EXPECT_EQ(read.method, Config{}.method);
  EXPECT_EQ(numbers(read.published), numbers(published::Config{}));
}

TEST(GhostFilterConfig, EveryKeyIsRead) {
  // Each number of the file changed in turn must change what is read: a key that is written but not read is a lie.
  const std::string text = shipped();
  std::size_t changed = 0, position = 0;
  while ((position = text.find("= ", position)) != std::string::npos) {
    position += 2;
    if (std::isdigit(static_cast<unsigned char>(text[position])) == 0) continue;
    std::string other = text;
    other.insert(position, "1");
    try {
      const Config read = read_config(config::Reader::parse(other, "ghost_filter.toml"));
      EXPECT_NE(numbers(read.published), numbers(published::Config{})) << other.substr(position - 20, 30);
    } catch (const config::Error&) {
      // Out of its range, hence read.
    }
    ++changed;
  }
  EXPECT_EQ(changed, numbers(published::Config{}).size());
}

TEST(GhostFilterConfig, AMethodThatIsNoneIsRefused) {
  EXPECT_THROW(static_cast<void>(read_config(config::Reader::parse("method = \"magic\"", "x.toml"))), config::Error);
}

}  // namespace
}  // namespace boresight::ghosts
