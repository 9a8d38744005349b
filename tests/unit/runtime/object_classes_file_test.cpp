#include "services/common/runtime/config/object_classes_file.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::config {
namespace {

using extended_object::ObjectClassField;
using extended_object::ObjectClassTable;
using testing::HasSubstr;

/// All numbers of a table, field by field.
std::vector<double> all_numbers(ObjectClassTable table) {
  std::vector<double> all;
  for (const ObjectClassField& field : extended_object::object_class_fields()) {
    for (auto& model : table) all.push_back(field.value_of(model));
  }
  return all;
}

ObjectClassTable read_classes(const std::string& text) {
  return read_object_classes(Reader::parse(text, "classes.toml"));
}

std::string error_in_classes(const std::string& text) {
  try {
    static_cast<void>(read_classes(text));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ObjectClassesFile, ShippedFileHasTheDefaults) {
  const std::filesystem::path shipped =
      std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/object_classes.toml";
  EXPECT_EQ(all_numbers(read_object_classes(Reader::open(shipped))),
            all_numbers(extended_object::object_class_table_defaults()));
  // Each key stands there: without one of them, a shipped value could change in the code alone.
  Reader root = Reader::open(shipped);
  for (const ObjectClassField& field : extended_object::object_class_fields()) {
    EXPECT_TRUE((field.section.empty() ? root : root.table(field.section)).has(field.key)) << field.key;
  }
}

TEST(ObjectClassesFile, EachNumberIsReadIntoItsPlace) {
  const std::vector<double> before = all_numbers(extended_object::object_class_table_defaults());
  std::size_t index = 0;
  for (const ObjectClassField& field : extended_object::object_class_fields()) {
    if (field.section.empty()) {  // the shares of classes, which sum to 1: below
      index += field.defaults.size();
      continue;
    }
    for (std::size_t i = 0; i < field.defaults.size(); ++i, ++index) {
      std::vector<double> values(field.defaults.begin(), field.defaults.end());
      values[i] = 0.5 * (values[i] + field.greatest);
      std::vector<double> expected = before;
      expected[index] = values[i];
      EXPECT_EQ(all_numbers(
                    read_classes(fmt::format("[{}]\n{} = [{}]\n", field.section, field.key, fmt::join(values, ", ")))),
                expected)
          << field.key;
    }
  }
  EXPECT_EQ(index, before.size());
  const ObjectClassTable table = read_classes("prior_share = [0.1, 0.15, 0.2, 0.25, 0.3]");
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_DOUBLE_EQ(table[i].prior_share, 0.1 + 0.05 * static_cast<double>(i));
  }
}

TEST(ObjectClassesFile, DefaultsAreAllowed) {
  for (const ObjectClassField& field : extended_object::object_class_fields()) {
    for (const double value : field.defaults) {
      EXPECT_GE(value, field.least) << field.key;
      EXPECT_LE(value, field.greatest) << field.key;
    }
  }
}

TEST(ObjectClassesFile, WrongValuesAreErrorsWithPlaceKeyAndRange) {
  EXPECT_THAT(error_in_classes("[size]\nlength_mean_m = [0.7, 1.8, 4.6, 5.6, 99]\n"),
              AllOf(HasSubstr("classes.toml:2: size.length_mean_m"), HasSubstr("element 5"), HasSubstr("5 numbers"),
                    HasSubstr("30")));
  EXPECT_THAT(error_in_classes("[size]\nlength_mean_m = [0.7, 1.8]\n"), HasSubstr("has 2 elements"));
  EXPECT_THAT(error_in_classes("[size]\nlength_mean_m = 4.6\n"), HasSubstr("array of 5 numbers"));
  EXPECT_THAT(error_in_classes("[size]\nlength_m = [1, 2, 3, 4, 5]\n"), HasSubstr("size.length_m: unknown key"));
  EXPECT_THAT(error_in_classes("[pedestrian]\nlength_mean_m = 0.7\n"), HasSubstr("pedestrian: unknown key"));
  EXPECT_THAT(error_in_classes("prior_share = [0.2, 0.2, 0.2, 0.2, 0.3]\n"),
              HasSubstr("classes.toml:1: prior_share: the shares must sum to 1"));
}

}  // namespace
}  // namespace boresight::config
