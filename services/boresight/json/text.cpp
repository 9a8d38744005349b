#include "services/boresight/json/text.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

namespace boresight::json {

std::string line(const Value& value) {
  return value.dump(-1, ' ', false, Value::error_handler_t::replace) + "\n";
}

std::string document(const Value& value) {
  return value.dump(2, ' ', false, Value::error_handler_t::replace) + "\n";
}

double shortest(float value) {
  if (!std::isfinite(value)) return value;
  std::array<char, 32> digits;
  const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  double result = value;
  static_cast<void>(std::from_chars(digits.data(), end, result));
  return result;
}

}  // namespace boresight::json
