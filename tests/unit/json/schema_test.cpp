// config/schema/json.md lists every key that is written, with its type, and no other.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/json/samples.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::json {
namespace {

using Kinds = std::set<std::string>;

std::string kind_of(const Value& value) {
  if (value.is_null()) return "null";
  if (value.is_boolean()) return "boolean";
  if (value.is_string()) return "text";
  return value.is_number_integer() ? "whole" : "number";
}

/// The kinds of every value by its path, in the notation of the page.
void collect(const Value& value, const std::string& path, std::map<std::string, Kinds>& kinds) {
  if (value.is_object()) {
    for (const auto& [key, each] : value.items()) collect(each, path.empty() ? key : path + "." + key, kinds);
  } else if (value.is_array()) {
    for (const Value& each : value) collect(each, path + "[]", kinds);
  } else {
    kinds[path].insert(kind_of(value));
  }
}

/// The paths that a key with {a,b} stands for.
std::vector<std::string> expanded(const std::string& key) {
  const std::size_t open = key.find('{');
  if (open == std::string::npos) return {key};
  const std::size_t close = key.find('}', open);
  std::vector<std::string> paths;
  std::istringstream words(key.substr(open + 1, close - open - 1));
  for (std::string word; std::getline(words, word, ',');) {
    for (const std::string& path : expanded(key.substr(0, open) + word + key.substr(close + 1))) paths.push_back(path);
  }
  return paths;
}

struct Row {
  std::string type;
  bool is_nullable = false;
};

/// Documented paths; one that ends with * stands for any key at its end.
std::map<std::string, Row> rows_of(const std::vector<schema_page::Cells>& table) {
  std::map<std::string, Row> rows;
  for (const schema_page::Cells& cells : table) {
    const std::string key = schema_page::code(cells.at(0));
    if (key.empty()) continue;
    EXPECT_EQ(cells.size(), 5u) << key;
    for (const std::string& path : expanded(key)) {
      EXPECT_TRUE(rows.emplace(path, Row{cells.at(1), !cells.at(3).empty()}).second) << path << " has two rows";
    }
  }
  return rows;
}

/// The documented path for a written one; "" if there is none.
std::string row_for(const std::string& path, const std::map<std::string, Row>& rows) {
  if (rows.contains(path)) return path;
  for (const auto& [pattern, row] : rows) {
    const std::string begin = pattern.substr(0, pattern.size() - 1);
    if (pattern.ends_with('*') && path.starts_with(begin) && path.size() > begin.size()) return pattern;
  }
  return "";
}

bool is_allowed(const std::string& kind, const Row& row) {
  if (kind == "null") return row.is_nullable;
  return kind == row.type || (kind == "whole" && row.type == "number");
}

TEST(JsonSchema, ListsExactlyTheKeysThatAreWrittenWithTheirTypes) {
  const auto sections = schema_page::sections(schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/json.md"));
  const auto written = testing::written();
  for (const auto& [section, values] : written) {
    ASSERT_TRUE(sections.contains(section)) << section;
    const std::map<std::string, Row> rows = rows_of(sections.at(section));
    std::map<std::string, Kinds> kinds;
    for (const Value& value : values) collect(value, "", kinds);
    std::set<std::string> seen;
    for (const auto& [path, of_path] : kinds) {
      const std::string row = row_for(path, rows);
      EXPECT_NE(row, "") << section << ": no row for " << path;
      if (row.empty()) continue;
      seen.insert(row);
      for (const std::string& kind : of_path) {
        EXPECT_TRUE(is_allowed(kind, rows.at(row))) << section << ": " << path << " is written as " << kind;
      }
    }
    for (const auto& [path, row] : rows) EXPECT_TRUE(seen.contains(path)) << section << ": nobody writes " << path;
  }
  for (const auto& [section, table] : sections) EXPECT_TRUE(written.contains(section)) << "not tested: " << section;
}

TEST(JsonSchema, NameOfARadarIsWrittenUnchangedEverywhere) {
  // Without its quotes: a status of rt/diagnostics has the name at its end.
  const std::string name = Value(testing::kName).dump();
  const std::string text = name.substr(1, name.size() - 1);
  const auto written = testing::written();
  for (const char* const section : {"Run folder: run.json", "boresight monitor", "boresight align",
                                    "boresight diagnostics", "boresight diagnostics --array"}) {
    EXPECT_NE(written.at(section).at(0).dump().find(text), std::string::npos) << section;
  }
}

}  // namespace
}  // namespace boresight::json
