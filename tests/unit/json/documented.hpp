// The keys that config/schema/json.md documents, beside those of a JSON value.
#pragma once

#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::json::testing {

using Kinds = std::set<std::string>;

inline std::string kind_of(const Value& value) {
  if (value.is_null()) return "null";
  if (value.is_boolean()) return "boolean";
  if (value.is_string()) return "text";
  return value.is_number_integer() ? "whole" : "number";
}

/// The kinds of every value by its path, in the notation of the page.
inline void collect(const Value& value, const std::string& path, std::map<std::string, Kinds>& kinds) {
  if (value.is_object()) {
    for (const auto& [key, each] : value.items()) collect(each, path.empty() ? key : path + "." + key, kinds);
  } else if (value.is_array()) {
    for (const Value& each : value) collect(each, path + "[]", kinds);
  } else {
    kinds[path].insert(kind_of(value));
  }
}

/// The paths that a key with {a,b} stands for.
inline std::vector<std::string> expanded(const std::string& key) {
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
inline std::map<std::string, Row> rows_of(const std::vector<schema_page::Cells>& table) {
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
inline std::string row_for(const std::string& path, const std::map<std::string, Row>& rows) {
  if (rows.contains(path)) return path;
  for (const auto& [pattern, row] : rows) {
    const std::string begin = pattern.substr(0, pattern.size() - 1);
    if (pattern.ends_with('*') && path.starts_with(begin) && path.size() > begin.size()) return pattern;
  }
  return "";
}

inline bool is_allowed(const std::string& kind, const Row& row) {
  if (kind == "null") return row.is_nullable;
  return kind == row.type || (kind == "whole" && row.type == "number");
}

/// The tables of the page by section.
inline std::map<std::string, std::vector<schema_page::Cells>> documented_sections() {
  return schema_page::sections(schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/json.md"));
}

/// Expects a row for every key of the values, with their types; returns the rows that were used.
inline std::set<std::string> expect_documented(const std::vector<Value>& values, const std::map<std::string, Row>& rows,
                                               const std::string& section) {
  std::map<std::string, Kinds> kinds;
  for (const Value& value : values) collect(value, "", kinds);
  std::set<std::string> used;
  for (const auto& [path, of_path] : kinds) {
    const std::string row = row_for(path, rows);
    EXPECT_NE(row, "") << section << ": no row for " << path;
    if (row.empty()) continue;
    used.insert(row);
    for (const std::string& kind : of_path) {
      EXPECT_TRUE(is_allowed(kind, rows.at(row))) << section << ": " << path << " is written as " << kind;
    }
  }
  return used;
}

}  // namespace boresight::json::testing
