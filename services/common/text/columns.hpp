// Text in columns of a terminal, by displayed letters: "größte" takes six columns and eight bytes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace boresight::text {

/// Number of displayed characters of UTF-8.
[[nodiscard]] inline std::size_t columns(std::string_view text) {
  std::size_t columns = 0;
  for (const char c : text) columns += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
  return columns;
}

/// The text with blanks behind it up to `width` columns, and one at least.
[[nodiscard]] inline std::string padded(std::string_view text, std::size_t width) {
  const std::size_t used = columns(text);
  return std::string(text) + std::string(used < width ? width - used : 1, ' ');
}

}  // namespace boresight::text
