// config/schema/vehicle.md lists every key that the reader of vehicle files knows, with its bounds.
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::config {
namespace {

using schema_page::Cells;
using schema_page::code;
using testing::HasSubstr;

using Keys = std::map<std::string, std::string>;

const std::map<std::string, std::string> kSources = {
    {"can", "link = \"can\", interface = \"can0\""},
    {"udp", "link = \"udp\", address = \"224.0.2.2\", port = 42102, sender = \"10.13.1.113\""},
    {"someip", "link = \"someip\", address = \"10.0.0.1\", instance = 1"}};
const std::map<std::string, std::string> kLinkOfProfile = {{"ars548", "udp"},  {"srr520", "can"},
                                                           {"ars408", "can"},  {"toyota", "can"},
                                                           {"mapping", "can"}, {"boresight", "someip"}};

std::map<std::string, std::vector<Cells>> page() {
  return schema_page::sections(schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/vehicle.md"));
}

std::string problems(const std::string& text) {
  try {
    static_cast<void>(read_vehicle(Reader::parse(text, "x.toml")));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Assignments with dotted keys; `changed` overrides `all`.
std::string assignments(Keys all, const Keys& changed) {
  for (const auto& [key, value] : changed) all[key] = value;
  std::string text;
  for (const auto& [key, value] : all) text += key + " = " + value + "\n";
  return text;
}

/// A vehicle without radars, whose ego keys are named as on the page ("ego.speed_std_mps").
std::string vehicle(const std::string& profile, const Keys& changed) {
  Keys all = {{"name", "\"x\""}, {"ego.profile", "\"" + profile + "\""}};
  const std::string link = profile == "boresight" ? "someip" : "can";
  if (!changed.contains("ego.source")) all["ego.source"] = "{" + kSources.at(link) + "}";
  return assignments(all, changed);
}

/// A vehicle with one radar; `source` replaces that of the profile's link.
std::string radar(const std::string& profile, const Keys& changed, const std::string& source = "") {
  const Keys all = {{"id", "1"},
                    {"name", "\"r\""},
                    {"profile", "\"" + profile + "\""},
                    {"source", "{" + (source.empty() ? kSources.at(kLinkOfProfile.at(profile)) : source) + "}"},
                    {"mounting_pose.position_m", "[3.0, 0.0, 0.5]"},
                    {"mounting_pose.yaw_deg", "0.0"}};
  return vehicle("toyota", {}) + "[[radar]]\n" + assignments(all, changed);
}

/// Documented keys of a section below `prefix`: their first parts.
std::set<std::string> documented(const std::vector<Cells>& rows, const std::string& prefix, std::size_t column = 0) {
  std::set<std::string> keys;
  for (const Cells& row : rows) {
    const std::string key = code(row.at(column));
    if (!key.empty() && key.starts_with(prefix))
      keys.insert(key.substr(prefix.size(), key.find('.', prefix.size()) - prefix.size()));
  }
  return keys;
}

std::set<std::string> known(const std::string& text) {
  return schema_page::known_keys(problems(text), "no_such_key");
}

TEST(VehicleSchema, PageListsExactlyTheKeysOfTheReader) {
  const auto sections = page();
  std::set<std::string> of_ego, of_radar;
  for (const char* profile : {"toyota", "mapping", "boresight"}) {
    of_ego.merge(known(vehicle(profile, {{"ego.no_such_key", "1"}})));
  }
  EXPECT_EQ(of_ego, documented(sections.at("Vehicle"), "ego."));
  for (const auto& [profile, link] : kLinkOfProfile) of_radar.merge(known(radar(profile, {{"no_such_key", "1"}})));
  EXPECT_EQ(of_radar, documented(sections.at("Radar"), ""));
  for (const std::string table :
       {"mounting_pose", "field_of_view", "antenna", "region_of_interest", "noise", "tolerance", "limit"}) {
    EXPECT_EQ(known(radar("toyota", {{table + ".no_such_key", "1"}})), documented(sections.at("Radar"), table + "."));
  }
  EXPECT_EQ(known(radar("ars548", {{"e2e.no_such_key", "1"}})), documented(sections.at("e2e"), ""));
}

TEST(VehicleSchema, PageListsExactlyTheKeysOfEachSource) {
  std::map<std::string, std::set<std::string>> documented_keys;
  std::string link;
  const auto sections = page();  // a range-for does not extend the life of a temporary
  for (const Cells& row : sections.at("source")) {
    if (!code(row[0]).empty()) link = code(row[0]);
    std::string keys = row[1];
    std::erase(keys, '`');
    std::istringstream names(keys);
    for (std::string name; link != "" && std::getline(names, name, ',');) {
      documented_keys[link].insert(schema_page::trimmed(name));
    }
  }
  for (const auto& [profile, name] : kLinkOfProfile) {
    std::set<std::string> keys = known(radar(profile, {}, kSources.at(name) + ", no_such_key = 1"));
    EXPECT_EQ(keys.erase("link"), 1u) << profile;
    EXPECT_EQ(keys, documented_keys["\"" + name + "\""]) << profile;
  }
}

TEST(VehicleSchema, ProfilesAndTheirLinksAreThoseOfTheReader) {
  std::map<std::string, std::string> documented_links;
  const auto sections = page();
  for (const Cells& row : sections.at("Profiles of radars")) {
    std::string profile = code(row[0]), link = code(row[2]);
    std::erase(profile, '"');
    std::erase(link, '"');
    if (!profile.empty()) documented_links[profile] = link;
  }
  EXPECT_EQ(documented_links, kLinkOfProfile);
  for (const auto& [profile, link] : documented_links) {
    for (const auto& [other, source] : kSources) {
      const std::string text = radar(profile, {}, source);
      if (other == link) {
        EXPECT_THAT(problems(text), testing::Not(HasSubstr("needs link"))) << profile << " " << other;
      } else {
        EXPECT_THAT(problems(text), HasSubstr("needs link = \"" + link + "\"")) << profile << " " << other;
      }
    }
  }
}

TEST(VehicleSchema, BoundsAreThoseOfTheReader) {
  const std::map<std::string, std::string> profile_of = {{"sensor_id", "ars408"}};
  std::size_t checked = 0;
  const auto sections = page();
  for (const auto& [section, prefix, type_column] :
       {std::tuple("Vehicle", "", 1), std::tuple("Radar", "", 1), std::tuple("e2e", "e2e.", 1)}) {
    for (const Cells& row : sections.at(section)) {
      const std::string key = code(row[0]);
      const bool has_unit = std::string(section) != "e2e";
      const std::string type = row.at(static_cast<std::size_t>(type_column)), range = row.at(has_unit ? 3 : 2);
      const auto bounds = schema_page::bounds(range);
      if (key.empty() || !bounds || type == "string" || type == "word") continue;
      const auto problem = [&](double value) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), type == "integer" ? "%.0f" : "%.9f", value);
        std::string assigned = text.data();
        if (type == "3 numbers") assigned = "[" + assigned + ", 0.0, 0.0]";
        const Keys changed = {{prefix + key, assigned}};
        if (std::string(section) == "Vehicle") return problems(vehicle("toyota", changed));
        const auto profile = profile_of.find(key);
        return problems(radar(profile == profile_of.end() ? "ars548" : profile->second, changed));
      };
      const auto [low, high] = *bounds;
      const double step = type == "integer" ? 1.0 : 1e-6 * std::max(1.0, std::abs(high));
      const double below = type == "integer" || low <= 0.0 ? low - step : 0.9 * low;
      const auto is_refused = testing::AnyOf(HasSubstr("is out of range"), HasSubstr("is not a number in range"));
      for (const double inside : {low, high}) {
        EXPECT_THAT(problem(inside), testing::Not(is_refused)) << section << ": " << key << " " << inside;
      }
      for (const double outside : {below, high + step}) {
        EXPECT_THAT(problem(outside), is_refused) << section << ": " << key << " " << outside;
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 25u);
}

}  // namespace
}  // namespace boresight::config
