// Text from outside, made safe for a terminal and a log. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace boresight::text {

enum class LineBreaks { kReplaced, kKept };

/// First character of a text of UTF-8.
struct Character {
  std::size_t bytes = 1;
  char32_t code = 0;
  bool is_valid = false;  ///< false: the first byte begins no character of UTF-8, and `bytes` is 1
};

/// Strict: no overlong form, no surrogate, nothing beyond U+10FFFF. `text` is not empty.
[[nodiscard]] inline Character first_character(std::string_view text) {
  constexpr std::array<char32_t, 5> kSmallestCode = {0, 0, 0x80, 0x800, 0x10000};
  constexpr char32_t kLargestCode = 0x10FFFF;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80U) return {1, lead, true};
  const std::size_t bytes = lead >= 0xF0U && lead < 0xF8U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC0U || lead >= 0xF8U || text.size() < bytes) return {};
  char32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kSmallestCode[bytes] || code > kLargestCode || is_surrogate) return {};
  return {bytes, code, true};
}

/// Control characters of both ranges, separators of lines and paragraphs, and marks that change the reading direction.
[[nodiscard]] constexpr bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code <= 0x9F) || code == 0x200E || code == 0x200F || code == 0x061C ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

/// The text with ? in place of each control character and of each byte that is not UTF-8. A control character would
/// move the cursor, change the terminal or begin a line. Applied twice, it changes nothing more.
[[nodiscard]] inline std::string printable(std::string_view text, LineBreaks breaks = LineBreaks::kReplaced) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const Character next = first_character(text);
    const bool is_kept_break = next.code == '\n' && breaks == LineBreaks::kKept;
    if (next.is_valid && (!is_control(next.code) || is_kept_break)) {
      shown.append(text.substr(0, next.bytes));
    } else {
      shown += '?';
    }
    text.remove_prefix(next.bytes);
  }
  return shown;
}

}  // namespace boresight::text
