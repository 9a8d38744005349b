// config/schema/mapping.md lists every key that the reader of mapping files knows, with its bounds and words.
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::ingest {
namespace {

using schema_page::Cells;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kSchemaDbc = R"(BO_ 256 HEAD: 8 R
 SG_ COUNTER : 0|16@1+ (1,0) [0|0] "" X
BO_ 257 LIST: 16 R
 SG_ NUMBER : 0|8@1+ (1,0) [0|0] "" X
 SG_ RANGE : 16|16@1+ (0.01,0) [0|0] "m" X
 SG_ AZIMUTH : 32|12@1- (0.05,0) [0|0] "deg" X
 SG_ RATE : 64|16@1- (1,0) [0|0] "m/s" X
 SG_ EXISTENCE : 80|7@1+ (1,0) [0|0] "%" X
BO_ 514 MOTION: 8 C
 SG_ V : 0|16@1+ (0.01,0) [0|0] "km/h" X
 SG_ YAW : 16|16@1- (0.01,0) [0|0] "deg/s" X
 SG_ PULSE : 32|16@1+ (1,0) [0|0] "" X
)";

/// Assignments of a table of the mapping file.
using Assignments = std::map<std::string, std::string>;
/// Tables by their header in the file, in the order of the file; "" is the root.
using File = std::vector<std::pair<std::string, Assignments>>;

File radar_file() {
  return {{"", {{"kind", "\"radar\""}, {"dbc", "\"x\""}}},
          {"[cycle]", {{"end", "\"count\""}}},
          {"[header]", {{"message", "\"HEAD\""}, {"counts", "[\"COUNTER\"]"}, {"e2e.profile", "\"P01\""}}},
          {"[[detections]]", {{"slot_by", "\"signal\""}, {"slots", "64"}}},
          {"[[detections.message]]", {{"name", "\"LIST\""}, {"slot_signal", "\"NUMBER\""}, {"e2e.profile", "\"P01\""}}},
          {"[detections.signals]", {}},
          {"[detections.signals.range]", {{"signal", "\"RANGE\""}, {"unit", "\"m\""}}},
          {"[detections.signals.azimuth]", {{"signal", "\"AZIMUTH\""}, {"unit", "\"deg\""}}},
          {"[detections.signals.range_rate]", {{"signal", "\"RATE\""}, {"unit", "\"m/s\""}}},
          {"[detections.signals.existence]", {{"signal", "\"EXISTENCE\""}, {"unit", "\"%\""}}},
          {"[[detections.valid]]", {{"signal", "\"NUMBER\""}, {"is", "[1]"}}}};
}

/// Speed comes from a speed signal, or from pulses.
File ego_file(bool from_pulses) {
  File file = {{"", {{"kind", "\"ego\""}, {"dbc", "\"x\""}}},
               {"[yaw_rate]", {{"message", "\"MOTION\""}, {"signals", "[\"YAW\"]"}, {"unit", "\"deg/s\""}}},
               {"[steering_angle]", {{"message", "\"MOTION\""}, {"signals", "[\"YAW\"]"}, {"unit", "\"deg\""}}},
               {"[reverse]", {{"message", "\"MOTION\""}, {"signal", "\"PULSE\""}, {"is", "[1]"}}}};
  if (from_pulses) {
    file.push_back({"[pulses]", {{"message", "\"MOTION\""}, {"signals", "[\"PULSE\"]"}, {"metres_per_pulse", "0.02"}}});
  } else {
    file.push_back({"[speed]", {{"message", "\"MOTION\""}, {"signals", "[\"V\"]"}, {"unit", "\"km/h\""}}});
  }
  return file;
}

std::string problems_of(File file, const std::string& header, const std::string& key, const std::string& value) {
  std::string text;
  bool is_there = false;
  for (auto& [name, assignments] : file) {
    is_there |= name == header;
    if (name == header) assignments[key] = value;
    text += name + "\n";
    for (const auto& [each, assigned] : assignments) text += each + " = " + assigned + "\n";
  }
  EXPECT_TRUE(is_there) << header;
  const auto load = [](const std::string&) { return dbc::parse_dbc(kSchemaDbc, "x.dbc"); };
  try {
    const config::Reader root = config::Reader::parse(text, "x.toml");
    if (file.front().second.at("kind") == "\"radar\"") {
      static_cast<void>(read_radar_mapping(root, load));
    } else {
      static_cast<void>(read_ego_mapping(root, load));
    }
  } catch (const config::Error& error) {
    return error.what();
  }
  return "";
}

/// Keys that the reader knows in a table; `below` is a table within it, such as "e2e.".
std::set<std::string> known(const File& file, const std::string& header, const std::string& below = "") {
  return schema_page::known_keys(problems_of(file, header, below + "no_such_key", "1"), "no_such_key");
}

/// Texts in backticks. A key without a dot has the table of the first one: "`yaw_rate.message`, `signals`".
std::vector<std::string> keys_of(const std::string& cell) {
  std::vector<std::string> keys;
  std::size_t at = cell.find('`');
  while (at != std::string::npos) {
    const std::size_t end = cell.find('`', at + 1);
    keys.push_back(cell.substr(at + 1, end - at - 1));
    const std::size_t dot = keys.front().find('.');
    if (dot != std::string::npos && keys.back().find('.') == std::string::npos) {
      keys.back().insert(0, keys.front().substr(0, dot + 1));
    }
    at = end == std::string::npos ? end : cell.find('`', end + 1);
  }
  return keys;
}

std::map<std::string, std::vector<Cells>> mapping_page() {
  return schema_page::sections(schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/mapping.md"));
}

/// Documented keys of a section below `prefix`: their first parts.
std::set<std::string> documented(const std::string& section, const std::string& prefix = "") {
  std::set<std::string> result;
  const auto page = mapping_page();
  for (const Cells& row : page.at(section)) {
    if (row.at(0) == "key") continue;
    for (const std::string& key : keys_of(row.at(0))) {
      if (key.starts_with(prefix)) {
        result.insert(key.substr(prefix.size(), key.find('.', prefix.size()) - prefix.size()));
      }
    }
  }
  return result;
}

std::set<std::string> both(std::set<std::string> keys, const std::set<std::string>& others) {
  keys.insert(others.begin(), others.end());
  return keys;
}

const std::string kBothKinds = "Keys of both kinds", kProtection = "Protection of a message",
                  kConversion = "Conversion of a signal", kRadarKeys = "kind = \"radar\"", kEgoKeys = "kind = \"ego\"";

TEST(MappingSchema, PageListsExactlyTheKeysOfARadar) {
  const File file = radar_file();
  const std::set<std::string> protection = documented(kProtection);
  EXPECT_EQ(known(file, ""), both(both(documented(kBothKinds), documented(kRadarKeys)), {"detections"}));
  EXPECT_EQ(known(file, "[cycle]"), documented(kRadarKeys, "cycle."));
  EXPECT_EQ(known(file, "[header]"), both(documented(kRadarKeys, "header."), protection));
  EXPECT_EQ(known(file, "[header]", "e2e."), documented(kProtection, "e2e."));
  EXPECT_EQ(known(file, "[[detections]]"), documented("detections"));
  EXPECT_EQ(known(file, "[[detections.message]]"), both(documented("detections", "message."), protection));
  EXPECT_EQ(known(file, "[[detections.message]]", "e2e."), documented(kProtection, "e2e."));
  EXPECT_EQ(known(file, "[[detections.valid]]"), both(documented("detections", "valid."), {"message"}));
  EXPECT_EQ(known(file, "[detections.signals]"), documented("detections.signals"));
  EXPECT_EQ(known(file, "[detections.signals.range]"), both(documented(kConversion), {"signal", "message"}));
}

TEST(MappingSchema, PageListsExactlyTheKeysOfEgoSignals) {
  const File of_speed = ego_file(false), of_pulses = ego_file(true);
  const std::set<std::string> protection = documented(kProtection), conversion = documented(kConversion);
  EXPECT_EQ(both(known(of_speed, ""), known(of_pulses, "")), both(documented(kBothKinds), documented(kEgoKeys)));
  EXPECT_EQ(known(of_speed, "[speed]"), both(both(documented(kEgoKeys, "speed."), protection), conversion));
  EXPECT_EQ(known(of_pulses, "[pulses]"), both(documented(kEgoKeys, "pulses."), protection));
  for (const std::string quantity : {"yaw_rate", "steering_angle"}) {
    EXPECT_EQ(known(of_speed, "[" + quantity + "]"),
              both(both(documented(kEgoKeys, quantity + "."), protection), conversion));
  }
  EXPECT_EQ(known(of_speed, "[reverse]"), both(documented(kEgoKeys, "reverse."), protection));
}

/// A table of a file, where the keys of a section of the page stand.
struct Place {
  std::string section, prefix;  ///< of the page
  File file;
  std::string header, below;  ///< where the keys stand
};

std::vector<Place> places() {
  return {{kBothKinds, "", radar_file(), "", ""},
          {kProtection, "", radar_file(), "[header]", ""},
          {kConversion, "", radar_file(), "[detections.signals.range]", ""},
          {kRadarKeys, "cycle.", radar_file(), "[cycle]", ""},
          {kRadarKeys, "header.", radar_file(), "[header]", ""},
          {"detections", "message.", radar_file(), "[[detections.message]]", ""},
          {"detections", "", radar_file(), "[[detections]]", ""},
          {kEgoKeys, "speed.", ego_file(false), "[speed]", ""},
          {kEgoKeys, "pulses.", ego_file(true), "[pulses]", ""},
          {kEgoKeys, "yaw_rate.", ego_file(false), "[yaw_rate]", ""},
          {kEgoKeys, "steering_angle.", ego_file(false), "[steering_angle]", ""}};
}

/// Whether the key stands in this table itself. E2E keys are dotted keys of the header.
bool stands_in(const Place& place, const std::string& key) {
  if (key.empty() || !key.starts_with(place.prefix)) return false;
  return place.section == kProtection || key.find('.', place.prefix.size()) == std::string::npos;
}

TEST(MappingSchema, BoundsAreThoseOfTheReader) {
  std::size_t checked = 0;
  const auto page = mapping_page();
  for (const Place& place : places()) {
    for (const Cells& row : page.at(place.section)) {
      const std::string key = schema_page::code(row[0]), type = row[1], range = row[2];
      const bool is_integer = type.find("integer") != std::string::npos || type.starts_with("[first");
      const bool is_number = type.starts_with("number") || type.starts_with("[min");
      const bool counts_elements = range.find("raw values") != std::string::npos;
      const bool is_open = range.find("range of the signal") != std::string::npos;
      if (!stands_in(place, key) || (!is_integer && !is_number) || counts_elements || is_open) continue;
      const auto bounds = schema_page::bounds(range);
      if (!bounds) continue;
      const auto [low, high] = *bounds;
      const auto problem = [&](double value) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), is_integer ? "%.0f" : "%.9f", value);
        std::string assigned = text.data();
        const bool is_pair = type.starts_with("[");
        const int elements = is_pair ? 2 : type.starts_with("16 ") ? 16 : 1;
        for (int i = 1; i < elements; ++i) assigned += std::string(", ") + text.data();
        if (is_pair || type.find("integers") != std::string::npos) assigned = "[" + assigned + "]";
        return problems_of(place.file, place.header, key.substr(place.prefix.size()), assigned);
      };
      const double step = is_integer ? 1.0 : 1e-6 * std::max(1.0, std::abs(high));
      const double below = is_integer || low <= 0.0 ? low - step : 0.9 * low;
      const auto is_refused = AnyOf(HasSubstr("is out of range; allowed"), HasSubstr("in range; must be"));
      for (const double inside : {low, high}) {
        EXPECT_THAT(problem(inside), Not(is_refused)) << key << " " << inside;
      }
      for (const double outside : {below, high + step}) {
        EXPECT_THAT(problem(outside), is_refused) << key << " " << outside;
      }
      ++checked;
    }
  }
  EXPECT_EQ(checked, 18u);
}

TEST(MappingSchema, WordsAreThoseOfTheReader) {
  std::size_t checked = 0;
  const auto page = mapping_page();
  for (const Place& place : places()) {
    std::map<std::string, std::set<std::string>> words;
    std::string key;
    for (const Cells& row : page.at(place.section)) {
      // Further words of a key stand in rows without its name.
      if (!row[0].empty()) key = row[1] == "word" ? schema_page::code(row[0]) : "";
      if (!stands_in(place, key)) continue;
      for (const std::string& word : keys_of(row[2])) words[key].insert(word);
    }
    words.erase("kind");
    words.erase("unit");  // depends on the quantity
    for (const auto& [name, allowed] : words) {
      const std::string problem =
          problems_of(place.file, place.header, name.substr(place.prefix.size()), "\"no_such_word\"");
      const std::string mark = "one of ";
      const std::size_t at = problem.find(mark, problem.find("no_such_word"));
      ASSERT_NE(at, std::string::npos) << name << ": " << problem;
      std::set<std::string> known_words;
      std::istringstream list(problem.substr(at + mark.size(), problem.find('\n', at) - at - mark.size()));
      for (std::string word; std::getline(list, word, ',');) known_words.insert(schema_page::trimmed(word));
      EXPECT_EQ(known_words, allowed) << name;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 6u);
}

}  // namespace
}  // namespace boresight::ingest
