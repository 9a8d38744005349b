#include "services/boresight/json/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/common/text/printable.hpp"

namespace boresight::json {

namespace {

/// The JSON text with an escape in place of each control character. The library escapes only those below U+0020; a
/// terminal obeys those from U+0080 to U+009F, too. Only strings contain such characters, so the value stays the same.
std::string with_escapes(std::string_view rest) {
  std::string escaped;
  escaped.reserve(rest.size());
  while (!rest.empty()) {
    const text::Character next = text::first_character(rest);
    if (next.code >= 0x7F && text::is_control(next.code)) {
      escaped += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(next.code));
    } else {
      escaped.append(rest.substr(0, next.bytes));
    }
    rest.remove_prefix(next.bytes);
  }
  return escaped;
}

std::string text_of(const Value& value, int indent) {
  return with_escapes(value.dump(indent, ' ', false, Value::error_handler_t::replace)) + "\n";
}

}  // namespace

std::string line(const Value& value) {
  return text_of(value, -1);
}

std::string document(const Value& value) {
  return text_of(value, 2);
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
