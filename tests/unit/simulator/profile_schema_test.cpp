// config/schema/radar_profile.md lists every key that the reader knows, with its bounds and default. The shipped
// profiles are valid, and each of their numbers is read.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::simulator {
namespace {

using schema_page::Cells;
using schema_page::code;
using testing::HasSubstr;

const std::string kName = "name = \"x\"\n";

std::string profile_problems(const std::string& text) {
  try {
    static_cast<void>(read_profile(config::Reader::parse(text, "x.toml")));
  } catch (const config::Error& error) {
    return error.what();
  }
  return "";
}

radar::Profile read_text(const std::string& text) {
  return read_profile(config::Reader::parse(text, "x.toml"));
}

/// A profile with lines in one table of it.
std::string text_in(const std::string& section, const std::string& lines) {
  return kName + (section == "The radar" ? lines : "[" + section + "]\n" + lines) + "\n";
}

std::map<std::string, std::vector<Cells>> profile_sections() {
  auto sections = schema_page::sections(schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/radar_profile.md"));
  EXPECT_EQ(sections.size(), 17u);
  // The ghost filter's: tests/unit/ghost_filter/weights_schema_test.cpp.
  EXPECT_EQ(sections.erase("evidence") + sections.erase("Weights of the evidence"), 2u);
  return sections;
}

TEST(ProfileSchema, DocumentListsExactlyTheKeysOfTheReader) {
  for (const auto& [section, rows] : profile_sections()) {
    const std::set<std::string> known =
        schema_page::known_keys(profile_problems(text_in(section, "no_such_key = 1")), "no_such_key");
    std::set<std::string> documented;
    for (const Cells& row : rows) {
      if (!code(row[0]).empty()) documented.insert(code(row[0]));
    }
    EXPECT_EQ(known, documented) << section;
  }
}

TEST(ProfileSchema, BoundsAreThoseOfTheReader) {
  std::size_t checked = 0;
  for (const auto& [section, rows] : profile_sections()) {
    for (const Cells& row : rows) {
      const std::string key = code(row[0]), type = row[1];
      const auto bounds = schema_page::bounds(row.size() > 3 ? row[3] : "");
      if (key.empty() || !bounds) continue;
      const auto [low, high] = *bounds;
      const auto problem = [&, section = section](double value) {
        std::array<char, 40> number{};
        std::snprintf(number.data(), number.size(), type == "integer" ? "%.0f" : "%.9f", value);
        std::string assigned = number.data();
        if (type.starts_with("list of ")) {
          const int count = std::stoi(type.substr(8));
          for (int i = 1; i < count; ++i) assigned += std::string(", ") + number.data();
          assigned = "[" + assigned + "]";
        }
        return profile_problems(text_in(section, key + " = " + assigned));
      };
      const double step = type == "integer" ? 1.0 : 1e-6 * std::max(1.0, std::abs(high));
      for (const double inside : {low, high}) {
        // The value may contradict another key, such as a median above its quantile.
        EXPECT_THAT(problem(inside), testing::Not(HasSubstr("range; "))) << section << "." << key;
        EXPECT_THAT(problem(inside), testing::Not(HasSubstr("not a number in range"))) << section << "." << key;
      }
      for (const double outside : {low - step, high + step}) {
        EXPECT_THAT(problem(outside), HasSubstr(key + ": ")) << section << "." << key << " " << outside;
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 80u);
}

TEST(ProfileSchema, DefaultsAreThoseOfTheReader) {
  std::size_t checked = 0;
  for (const auto& [section, rows] : profile_sections()) {
    for (const Cells& row : rows) {
      const std::string key = code(row[0]), value = row.size() > 4 ? code(row[4]) : "";
      if (key.empty() || value.empty()) continue;
      const std::string with = text_in(section, key + " = " + value);
      ASSERT_EQ(profile_problems(with), "") << section << "." << key;
      EXPECT_EQ(read_text(with), read_text(kName)) << section << "." << key;
      ++checked;
    }
  }
  EXPECT_GT(checked, 60u);
}

TEST(ProfileSchema, TheGhostFiltersTableIsPassedOver) {
  EXPECT_EQ(profile_problems(kName + "[evidence]\nanything = \"at all\"\n[evidence.alone]\nconstant = 1e9\n"), "");
  EXPECT_EQ(read_text(kName + "[evidence]\nprior_log_odds = 1.0\n"), read_text(kName));
}

TEST(ProfileSchema, ContradictionsAreRefused) {
  const std::map<std::string, std::string> wrong = {
      {"[presence]\nrange_m = [5.0, 5.0, 25.0, 35.0, 57.5, 72.5, 90.0]", "must increase"},
      {"[presence]\ncar = [0.1, 0.2]", "has 2 elements; must be an array of 7 numbers"},
      {"[strength]\nvehicle_p10_dbsm = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]", "must lie between"},
      {"[false_mover]\nmedian_per_scan = 3.0", "must not be less than median_per_scan"},
      {"[doppler_ambiguity]\nwidth_min_mps = 3.0\nwidth_max_mps = 2.0", "must not be less than width_min_mps"},
      {"[burst]\nevery_s = 5.0\nduration_max_s = 6.0", "must not be less than duration_max_s"},
      {"[burst]\nrange_min_m = 5.0\nrange_max_m = 4.0", "must not be less than range_min_m"}};
  for (const auto& [lines, problem] : wrong) EXPECT_THAT(profile_problems(kName + lines), HasSubstr(problem)) << lines;
}

TEST(RadarProfiles, ShippedOnesAreKnownByNameAndIdealHasEveryEffectOff) {
  EXPECT_THAT(radar_profile_names(), testing::ElementsAre("can_cluster", "ideal", "series_77ghz"));
  for (const std::string& name : radar_profile_names()) EXPECT_EQ(radar_profile(name).name, name);
  EXPECT_EQ(radar_profile("ideal"), radar::Profile{});
  EXPECT_FALSE(radar_profile("ideal").changes_detections());
  EXPECT_TRUE(radar_profile("series_77ghz").changes_detections());
  try {
    static_cast<void>(radar_profile("series"));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("known: can_cluster, ideal, series_77ghz"));
  }
}

TEST(RadarProfiles, AScenarioNamesOneForAllAndOneForSingleRadars) {
  const std::string text =
      "name = \"x\"\n[radars]\nprofile = \"series_77ghz\"\n"
      "profile_of = [{radar = 2, profile = \"can_cluster\"}]\n";
  Scenario s = read_scenario(config::Reader::parse(text, "x.toml"));
  EXPECT_EQ(s.effects.profile_of(1).name, "series_77ghz");
  EXPECT_EQ(s.effects.profile_of(2).name, "can_cluster");
  use_profile(s, "ideal");
  EXPECT_EQ(s.effects.profile_of(2).name, "ideal");
  const auto problem = [](const std::string& radars) -> std::string {
    try {
      static_cast<void>(read_scenario(config::Reader::parse("name = \"x\"\n[radars]\n" + radars, "x.toml")));
    } catch (const config::Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem("profile = \"none\""), HasSubstr("x.toml:3: radars.profile: radar profile \"none\" is unknown"));
  EXPECT_THAT(problem("profile = \"./absent.toml\""), HasSubstr("cannot be read"));
}

TEST(RadarProfiles, AFileIsReadByItsPath) {
  namespace fs = std::filesystem;
  const fs::path file = fs::temp_directory_path() / ("boresight-profile-" + std::to_string(::getpid()) + ".toml");
  {
    std::ofstream stream(file);
    stream << "name = \"mine\"\n[burst]\non = true\n";
  }
  EXPECT_TRUE(radar_profile(file.string()).burst.on);
  fs::remove(file);
}

}  // namespace
}  // namespace boresight::simulator
