#include "services/ingest_gateway/dbc/names.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace boresight::ingest::dbc {

namespace {

constexpr std::size_t kLongest = 64;  // names are compared by as many characters

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Levenshtein's distance.
std::size_t distance(std::string_view a, std::string_view b) {
  a = a.substr(0, kLongest);
  b = b.substr(0, kLongest);
  std::array<std::size_t, kLongest + 1> row{};
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

}  // namespace

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

std::vector<std::string> near_names(std::string_view name, const std::vector<std::string>& candidates) {
  constexpr std::size_t kMost = 3;
  std::vector<std::pair<std::size_t, const std::string*>> found;
  for (const std::string& candidate : candidates) {
    const std::size_t changes = distance(name, candidate);
    if (2 * changes <= std::min(name.size(), kLongest)) found.emplace_back(changes, &candidate);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(found.size(), kMost); ++i) names.push_back(*found[i].second);
  return names;
}

}  // namespace boresight::ingest::dbc
