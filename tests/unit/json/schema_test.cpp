// config/schema/json.md lists every key that is written, with its type, and no other.
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/json/documented.hpp"
#include "tests/unit/json/samples.hpp"

namespace boresight::json {
namespace {

TEST(JsonSchema, ListsExactlyTheKeysThatAreWrittenWithTheirTypes) {
  const auto sections = testing::documented_sections();
  const auto written = testing::written();
  for (const auto& [section, values] : written) {
    ASSERT_TRUE(sections.contains(section)) << section;
    const std::map<std::string, testing::Row> rows = testing::rows_of(sections.at(section));
    const std::set<std::string> used = testing::expect_documented(values, rows, section);
    for (const auto& [path, row] : rows) EXPECT_TRUE(used.contains(path)) << section << ": nobody writes " << path;
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
