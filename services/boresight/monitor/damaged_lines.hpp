// What a record held that could not be read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace boresight::monitor {

/// As an error shows it: what a damaged file holds may be long, and no text.
inline std::string quoted(std::string_view word) {
  constexpr std::size_t kMost = 24;
  std::string text(word.substr(0, kMost));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + text + (word.size() > kMost ? "…'" : "'");
}

/// Lines of a record that are not whole. Nothing of them is used, and they are told, since what they held is missing
/// from everything that is drawn from the record.
struct DamagedLines {
  std::uint64_t count = 0;
  std::string first;  ///< "scans.txt:17: y of detection 3 is '1.x', allowed: a number"

  void add(std::string_view file, std::uint64_t line, std::string_view why) {
    if (count++ == 0) first = fmt::format("{}:{}: {}", file, line, why);
  }
};

}  // namespace boresight::monitor
