#include "services/boresight/json/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

namespace boresight::json {

std::string line(const Value& value) {
  return value.dump(-1, ' ', false, Value::error_handler_t::replace) + "\n";
}

std::string document(const Value& value) {
  return value.dump(2, ' ', false, Value::error_handler_t::replace) + "\n";
}

namespace {

/// The number that the text stands for.
template <typename... Format>
double through_text(double value, Format... format) {
  if (!std::isfinite(value)) return value;
  std::array<char, 32> digits;
  const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), format...).ptr;
  double result = value;
  static_cast<void>(std::from_chars(digits.data(), end, result));
  return result;
}

}  // namespace

double shortest(float value) {
  return through_text(value, value);
}

double significant(double value) {
  return through_text(value, value + 0.0, std::chars_format::general, std::numeric_limits<float>::max_digits10);
}

}  // namespace boresight::json
