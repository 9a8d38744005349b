// The names that may have been meant by a name that does not exist. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boresight {

constexpr std::size_t kMaxNameCharacters = 64;  // compared; the rest of a longer name does not count

/// Levenshtein's distance without regard to case: the least number of characters to insert, delete or replace.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  a = a.substr(0, kMaxNameCharacters);
  b = b.substr(0, kMaxNameCharacters);
  std::array<std::size_t, kMaxNameCharacters + 1> row{};
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row[b.size()];
}

/// At most three candidates, the nearest first. A candidate is near if at most half of the name's characters change.
[[nodiscard]] inline std::vector<std::string> near_names(std::string_view name,
                                                         const std::vector<std::string>& candidates) {
  constexpr std::size_t kMaxNames = 3;
  std::vector<std::pair<std::size_t, const std::string*>> found;
  for (const std::string& candidate : candidates) {
    const std::size_t changes = edit_distance(name, candidate);
    if (2 * changes <= std::min(name.size(), kMaxNameCharacters)) found.emplace_back(changes, &candidate);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(found.size(), kMaxNames); ++i) names.push_back(*found[i].second);
  return names;
}

}  // namespace boresight
