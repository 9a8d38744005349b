// TOML texts as the parser gets them: toml++ 3.3 runs into undefined behaviour where characters outside ASCII stand in
// wrong places, so it gets none.
#pragma once

#include <string>
#include <string_view>

namespace boresight::config {

/// The text with each byte outside ASCII, and each "~", as "~x" and two hexadecimal digits. Those are allowed where
/// TOML allows any character (strings and comments), and refused where it does not.
[[nodiscard]] std::string encode_ascii(std::string_view text);

/// What was encoded so.
[[nodiscard]] std::string decode_ascii(std::string_view text);

}  // namespace boresight::config
