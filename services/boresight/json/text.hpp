// JSON as text: one room, so that names with blanks, quotes or damaged characters are written the same way everywhere.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace boresight::json {

/// Keys stay in the order in which they were added.
using Value = nlohmann::ordered_json;

/// One line with line feed. What is no number becomes null, damaged UTF-8 the replacement character. Control characters
/// and marks of reading direction are escaped (\u009b): names and texts may come from outside.
[[nodiscard]] std::string line(const Value& value);
/// The same indented by two blanks.
[[nodiscard]] std::string document(const Value& value);

/// The double with the same shortest text as the float: 0.3F is written as 0.3, not as 0.30000001192092896.
[[nodiscard]] double shortest(float value);

/// Rounded to the digits that a float has, for values that are not more accurate, and without the sign of zero.
[[nodiscard]] double significant(double value);

}  // namespace boresight::json
