#include "services/ingest_gateway/dbc/names.hpp"

namespace boresight::ingest::dbc {

std::optional<std::string> expand(std::string_view pattern, unsigned index) {
  std::string name;
  while (true) {
    const std::size_t open = pattern.find_first_of("{}");
    name += pattern.substr(0, open);
    if (open == std::string_view::npos) return name;
    pattern.remove_prefix(open);
    std::string digits = std::to_string(index);
    if (pattern.starts_with("{}")) {
      pattern.remove_prefix(2);
    } else if (pattern.size() >= 5 && pattern.starts_with("{:0") && pattern[3] >= '1' && pattern[3] <= '9' &&
               pattern[4] == '}') {
      const auto width = static_cast<std::size_t>(pattern[3] - '0');
      if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
      pattern.remove_prefix(5);
    } else {
      return std::nullopt;
    }
    name += digits;
  }
}

}  // namespace boresight::ingest::dbc
