#include "services/common/runtime/config/toml_text.hpp"

#include <charconv>

#include <fmt/format.h>

namespace boresight::config {

std::string encode_ascii(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  std::string encoded;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && c != '~') {
      encoded += c;
    } else {
      encoded += fmt::format("~x{:02X}", byte);
    }
  }
  return encoded;
}

std::string decode_ascii(std::string_view text) {
  std::string decoded;
  while (!text.empty()) {
    unsigned byte = 0;
    const bool is_encoded = text.size() >= 4 && text.starts_with("~x") &&
                            std::from_chars(text.data() + 2, text.data() + 4, byte, 16).ptr == text.data() + 4;
    decoded += is_encoded ? static_cast<char>(byte) : text.front();
    text.remove_prefix(is_encoded ? 4 : 1);
  }
  return decoded;
}

}  // namespace boresight::config
