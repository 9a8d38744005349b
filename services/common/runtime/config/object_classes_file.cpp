#include "services/common/runtime/config/object_classes_file.hpp"

#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

namespace boresight::config {

namespace {

constexpr double kRounding = 1e-6;  // of shares that are written in decimals

}  // namespace

extended_object::ObjectClassTable read_object_classes(Reader root) {
  extended_object::ObjectClassTable classes = extended_object::object_class_table_defaults();
  Reader table = root;
  std::string_view section;
  for (const extended_object::ObjectClassField& field : extended_object::object_class_fields()) {
    if (field.section != section) {
      section = field.section;
      table = root.table(section);
    }
    const std::vector<double> values = table.numbers(field.key, classes.size(), {field.least, field.greatest},
                                                     {field.defaults.begin(), field.defaults.end()});
    for (std::size_t i = 0; i < classes.size(); ++i) field.value_of(classes[i]) = values[i];
  }
  double shares = 0.0;
  for (const extended_object::ObjectClassModel& c : classes) shares += c.prior_share;
  if (std::abs(shares - 1.0) > kRounding) root.reject("prior_share", "the shares must sum to 1");
  root.finish();
  return classes;
}

}  // namespace boresight::config
