// Lines of a record that could not be read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace boresight::monitor {

/// A word as errors show it: at most 24 characters, and printable ones only.
inline std::string quoted(std::string_view word) {
  constexpr std::size_t kMost = 24;
  std::string text(word.substr(0, kMost));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + text + (word.size() > kMost ? "…'" : "'");
}

/// Lines of a record that are not complete. Nothing of them is used. They are reported, because their content is
/// missing from every result.
struct DamagedLines {
  std::uint64_t count = 0;
  std::string first;  ///< "monitor.jsonl:17: radars[2].yaw_deg is '1.x', allowed: a number"

  void add(std::string_view file, std::uint64_t line, std::string_view why) {
    if (count++ == 0) first = fmt::format("{}:{}: {}", file, line, why);
  }
};

}  // namespace boresight::monitor
