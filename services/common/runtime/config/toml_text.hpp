// Encodes TOML texts as ASCII for the parser: toml++ 3.3 has undefined behaviour for other characters in wrong places.
#pragma once

#include <string>
#include <string_view>

namespace boresight::config {

/// Replaces each byte outside ASCII, and each "~", by "~x" and two hexadecimal digits. TOML allows these characters
/// where it allows any character (strings and comments), and rejects them elsewhere.
[[nodiscard]] std::string encode_ascii(std::string_view text);

/// The inverse of encode_ascii().
[[nodiscard]] std::string decode_ascii(std::string_view text);

}  // namespace boresight::config
