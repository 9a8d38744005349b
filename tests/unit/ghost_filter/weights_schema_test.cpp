// config/schema/radar_profile.md lists every key of the table [evidence], with its number of weights and bounds.
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/ghost_filter/weights_file.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::ghosts {
namespace {

using schema_page::code;
using testing::HasSubstr;

std::vector<schema_page::Cells> evidence_rows(const std::string& section) {
  return schema_page::sections(schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/radar_profile.md"))
      .at(section);
}

std::set<std::string> evidence_keys(const std::string& section) {
  std::set<std::string> keys;
  for (const schema_page::Cells& row : evidence_rows(section)) {
    if (!code(row[0]).empty()) keys.insert(code(row[0]));
  }
  return keys;
}

std::string weights_problems(const std::string& text) {
  try {
    static_cast<void>(read_weights(config::Reader::parse(text, "x.toml")));
  } catch (const config::Error& error) {
    return error.what();
  }
  return "";
}

std::set<std::string> keys_of_reader(const std::string& table) {
  return schema_page::known_keys(weights_problems("[" + table + "]\nno_such_key = 1\n"), "no_such_key");
}

TEST(WeightsSchema, PageListsExactlyTheKeysOfTheReader) {
  EXPECT_EQ(evidence_keys("evidence"), keys_of_reader("evidence"));
  const std::set<std::string> with_tracks = evidence_keys("Weights of the evidence");
  EXPECT_EQ(with_tracks, keys_of_reader("evidence.with_tracks"));
  std::set<std::string> without = with_tracks;
  for (const char* of_tracks : {"track_sure", "track_unsure"}) EXPECT_EQ(without.erase(of_tracks), 1U);
  EXPECT_EQ(without, keys_of_reader("evidence.ratio"));
  for (const char* of_images : {"image_type_1", "image_type_2"}) EXPECT_EQ(without.erase(of_images), 1U);
  EXPECT_EQ(without, keys_of_reader("evidence.alone"));
}

TEST(WeightsSchema, LengthsAndBoundsAreThoseOfTheReader) {
  std::size_t checked = 0;
  for (const schema_page::Cells& row : evidence_rows("Weights of the evidence")) {
    const std::string key = code(row[0]), type = row[1];
    const auto bounds = schema_page::bounds(row[3]);
    if (key.empty() || !bounds) continue;
    const auto problem = [&](double value, int more) {
      std::ostringstream text;
      text << value;
      std::string assigned = text.str();
      if (type.starts_with("list of ")) {
        for (int i = 1; i < std::stoi(type.substr(8)) + more; ++i) assigned += ", " + text.str();
        assigned = "[" + assigned + "]";
      }
      return weights_problems("[evidence.with_tracks]\n" + key + " = " + assigned + "\n");
    };
    const std::string place = "evidence.with_tracks." + key + ":";
    for (const double inside : {bounds->first, bounds->second}) {
      EXPECT_THAT(problem(inside, 0), testing::Not(HasSubstr(place))) << key;
    }
    for (const double outside : {bounds->first - 0.01, bounds->second + 0.01}) {
      EXPECT_THAT(problem(outside, 0), HasSubstr(place)) << key;
    }
    if (type.starts_with("list of ")) {
      EXPECT_THAT(problem(0.0, 1), HasSubstr(place)) << key;
    }
    ++checked;
  }
  EXPECT_EQ(checked, kEvidences + 3U);
}

}  // namespace
}  // namespace boresight::ghosts
