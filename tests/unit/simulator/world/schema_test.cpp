// config/schema/scenario.md lists every key that the reader knows, with its bounds and default. The example on that
// page is a valid scenario.
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/simulator/scenario_file.hpp"
#include "services/simulator/world/reflections.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::simulator {
namespace {

using schema_page::Cells;
using schema_page::code;
using testing::HasSubstr;

std::string document() {
  return schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/scenario.md");
}

std::map<std::string, std::vector<Cells>> sections() {
  return schema_page::sections(document());
}

/// How a table of the document is written, and which other keys it requires.
struct Table {
  std::string before;                           // up to its assignments
  std::map<std::string, std::string> required;  // key → value
  bool is_inline;                               // {…} instead of lines
  std::string after;
};

/// Where a section's keys belong.
const std::map<std::string, Table>& tables() {
  static const std::string name = "name = \"x\"\n";
  static const std::string rail =
      name + "[[structure]]\nkind = \"guard_rail\"\nfrom_m = 0.0\nto_m = 9.0\nlateral_m = 1.0\n";
  static const std::string car = name + "[[body]]\nkind = \"car\"\nstart_m = 1.0\n";
  static const std::map<std::string, std::string> extent = {{"from_m", "0.0"}, {"to_m", "9.0"}};
  static const std::map<std::string, std::string> radar = {{"radar", "1"}};
  static const std::map<std::string, Table> tables = {
      {"The drive", {"", {{"name", "\"x\""}}, false, ""}},
      {"road", {name + "[road]\n", {}, false, ""}},
      {"road.segments", {name + "[road]\nsegments = [", {{"length_m", "50.0"}}, true, "]"}},
      {"road.waves", {name + "[road]\nwaves = [", {{"length_m", "50.0"}, {"curvature_per_m", "0.001"}}, true, "]"}},
      {"ego", {name + "[ego]\n", {}, false, ""}},
      {"ego.speed", {name + "[ego]\nspeed = [", {{"t_s", "1.0"}, {"speed_mps", "5.0"}}, true, "]"}},
      {"ego.lateral", {name + "[ego]\nlateral = [", {{"at_m", "1.0"}, {"lateral_m", "0.5"}}, true, "]"}},
      {"structure",
       {name + "[[structure]]\n",
        {{"kind", "\"guard_rail\""}, {"from_m", "0.0"}, {"to_m", "9.0"}, {"lateral_m", "1.0"}},
        false,
        ""}},
      {"structure.gaps", {rail + "gaps = [", extent, true, "]"}},
      {"scatter",
       {name + "[[scatter]]\n",
        {{"kind", "\"columns\""},
         {"from_m", "0.0"},
         {"to_m", "9.0"},
         {"lateral_min_m", "1.0"},
         {"lateral_max_m", "2.0"}},
        false,
        ""}},
      {"body", {name + "[[body]]\n", {{"kind", "\"car\""}, {"start_m", "1.0"}}, false, ""}},
      {"body.repeat", {car + "repeat = ", {}, true, ""}},
      {"radars", {name + "[radars]\n", {}, false, ""}},
      {"radars.profile_of", {name + "[radars]\nprofile_of = [", {{"radar", "1"}, {"profile", "\"ideal\""}}, true, "]"}},
      {"radars.misalignment", {name + "[radars]\nmisalignment = [", radar, true, "]"}},
      {"radars.step_change", {name + "[radars]\nstep_change = [", radar, true, "]"}},
      {"radars.blockage", {name + "[radars]\nblockage = [", radar, true, "]"}},
      {"radars.interference", {name + "[radars]\ninterference = [", {}, true, "]"}},
      {"radars.data_fault", {name + "[radars]\ndata_fault = [", {{"kind", "\"few\""}}, true, "]"}},
      {"radars.multipath", {name + "[radars]\nmultipath = ", {}, true, ""}},
      {"radars.resolution", {name + "[radars]\nresolution = ", {}, true, ""}},
      {"radars.sensitivity", {name + "[radars]\nsensitivity = ", {}, true, ""}},
      {"radars.real_car", {name + "[radars]\nreal_car = ", {}, true, ""}},
  };
  return tables;
}

/// A document with this value at the key; without a value it lacks the key.
std::string text_with(const Table& table, const std::string& key, const std::optional<std::string>& value,
                      const std::map<std::string, std::string>& others = {}) {
  std::map<std::string, std::string> all = table.required;
  for (const auto& [other, its] : others) all[other] = its;
  all.erase(key);
  if (value) all[key] = *value;
  std::string assignments;
  for (const auto& [k, v] : all) {
    assignments +=
        (assignments.empty() || !table.is_inline ? "" : ", ") + k + " = " + v + (table.is_inline ? "" : "\n");
  }
  return table.before + (table.is_inline ? "{" + assignments + "}" : assignments) + table.after + "\n";
}

std::string problems(const std::string& text) {
  try {
    static_cast<void>(read_scenario(config::Reader::parse(text, "x.toml")));
  } catch (const config::Error& error) {
    return error.what();
  }
  return "";
}

/// The default column as TOML. "0.12 rad" is exact for a key in degrees.
std::string value_of_default(const std::string& cell) {
  const std::string text = code(cell);
  if (!text.ends_with(" rad")) return text;
  std::array<char, 40> degrees{};
  std::snprintf(degrees.data(), degrees.size(), "%.17g", std::stod(text) / (M_PI / 180.0));
  return degrees.data();
}

TEST(Schema, DocumentListsExactlyTheKeysOfTheReader) {
  const auto documented = sections();
  for (const auto& [section, table] : tables()) {
    const std::set<std::string> known =
        schema_page::known_keys(problems(text_with(table, "no_such_key", "1")), "no_such_key");
    std::set<std::string> documented_keys;
    ASSERT_TRUE(documented.contains(section)) << section;
    for (const Cells& row : documented.at(section)) {
      if (!code(row[0]).empty()) documented_keys.insert(code(row[0]));
    }
    EXPECT_EQ(known, documented_keys) << section;
  }
}

TEST(Schema, BoundsAreThoseOfTheReader) {
  std::size_t checked = 0;
  const auto documented = sections();
  for (const auto& [section, table] : tables()) {
    for (const Cells& row : documented.at(section)) {
      const std::string key = code(row[0]), type = row[1], range = row[3];
      if (key.empty()) continue;
      ASSERT_EQ(row.size(), 6u) << section << "." << key;
      const auto bounds = schema_page::bounds(range);
      if (!bounds) {
        EXPECT_TRUE(type != "number" && type != "integer") << section << "." << key << " has no range";
        continue;
      }
      const auto [low, high] = *bounds;
      const auto problem = [&](double value) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), type == "integer" ? "%.0f" : "%.9f", value);
        return problems(text_with(table, key, text.data()));
      };
      const double step = type == "integer" ? 1.0 : 1e-6 * std::max(1.0, std::abs(high));
      for (const double inside : {low, high}) {
        // The value may contradict another key, such as an end before the beginning.
        EXPECT_THAT(problem(inside), testing::Not(HasSubstr("is out of range"))) << section << "." << key;
      }
      for (const double outside : {low - step, high + step}) {
        EXPECT_THAT(problem(outside), HasSubstr(key + ": ")) << section << "." << key << " " << outside;
        EXPECT_THAT(problem(outside), HasSubstr("is out of range; allowed: ")) << section << "." << key;
      }
      for (const char* nonsense : {"nan", "inf", "-inf", "\"five\"", "true", "[1.0]", "{a = 1}"}) {
        EXPECT_THAT(problems(text_with(table, key, nonsense)), HasSubstr(key)) << section << "." << key;
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 70u);
}

TEST(Schema, DefaultsAreThoseOfTheReader) {
  std::size_t checked = 0;
  const auto documented = sections();
  const auto read = [](const std::string& text) { return read_scenario(config::Reader::parse(text, "x.toml")); };
  for (const auto& [section, table] : tables()) {
    for (const Cells& row : documented.at(section)) {
      const std::string key = code(row[0]), cell = row[4];
      if (key.empty()) continue;
      const std::string without = text_with(table, key, std::nullopt);
      if (cell == "required") {
        EXPECT_THAT(problems(without), HasSubstr(key + ": is missing")) << section << "." << key;
        EXPECT_TRUE(table.required.contains(key)) << section << "." << key;
        continue;
      }
      ASSERT_EQ(problems(without), "") << section << "." << key;
      if (cell == "–") continue;
      ASSERT_FALSE(code(cell).empty()) << section << "." << key << ": " << cell;
      const std::string with = text_with(table, key, value_of_default(cell));
      ASSERT_EQ(problems(with), "") << section << "." << key;
      EXPECT_EQ(read(with), read(without)) << section << "." << key << " = " << value_of_default(cell);
      ++checked;
    }
  }
  EXPECT_GT(checked, 50u);
  // Defaults that depend on the kind.
  for (const char* section : {"structure", "scatter"}) {
    const auto& rows = documented.at(std::string(section) + " by kind");
    for (std::size_t r = 1; r < rows.size(); ++r) {
      for (std::size_t k = 1; k < rows[0].size(); ++k) {
        const std::string kind = "\"" + code(rows[0][k]) + "\"", key = code(rows[r][0]), value = code(rows[r][k]);
        const Table& table = tables().at(section);
        EXPECT_EQ(read(text_with(table, key, value, {{"kind", kind}})),
                  read(text_with(table, key, std::nullopt, {{"kind", kind}})))
            << section << " " << kind << ": " << key << " = " << value;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 100u);
  const auto& sizes = documented.at("size by kind");
  const std::map<std::string, BodyKind> kinds = {{"car", BodyKind::kCar},
                                                 {"van", BodyKind::kVan},
                                                 {"truck", BodyKind::kTruck},
                                                 {"pedestrian", BodyKind::kPedestrian},
                                                 {"cyclist", BodyKind::kCyclist}};
  for (std::size_t k = 1; k < sizes[0].size(); ++k) {
    const Dimensions size = dimensions_of(kinds.at(code(sizes[0][k])));
    EXPECT_EQ(std::stod(sizes[1][k]), size.length_m);
    EXPECT_EQ(std::stod(sizes[2][k]), size.width_m);
    EXPECT_EQ(std::stod(sizes[3][k]), size.height_m);
    EXPECT_EQ(std::stod(sizes[4][k]), size.side_low_m);
  }
}

TEST(Schema, KindsAreThoseOfTheReader) {
  const auto documented = sections();
  for (const char* section : {"structure", "scatter", "body"}) {
    const Cells& row = documented.at(section)[1];
    ASSERT_EQ(code(row[0]), "kind");
    // "must be one of "a", "b"" against "`"a"`, `"b"`".
    std::string words = row[3];
    std::erase(words, '`');
    EXPECT_THAT(problems(text_with(tables().at(section), "kind", "\"cat\"")), HasSubstr("must be one of " + words));
  }
}

TEST(Schema, ItsExampleIsAScenario) {
  const std::string text = document();
  const std::size_t begin = text.find("```toml\n") + 8;
  const std::string example = text.substr(begin, text.find("```\n", begin) - begin);
  ASSERT_EQ(problems(example), "");
  const Scenario s = read_scenario(config::Reader::parse(example, "example.toml"));
  EXPECT_EQ(s.name, "my_street");
  EXPECT_EQ(s.bodies.size(), 8u);
  EXPECT_EQ(s.effects.blockages.size(), 1u);
}

}  // namespace
}  // namespace boresight::simulator
