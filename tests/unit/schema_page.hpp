// The tables of a schema page (config/schema/*.md), for tests that compare the page with the reader of the keys.
#pragma once

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace boresight::schema_page {

inline std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::string trimmed(std::string text) {
  const auto is_space = [](char c) { return c == ' '; };
  text.erase(std::find_if_not(text.rbegin(), text.rend(), is_space).base(), text.end());
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), is_space));
  return text;
}

/// The content of a cell without its backticks; empty if the cell is no code.
inline std::string code(const std::string& text) {
  return text.size() >= 2 && text.front() == '`' && text.back() == '`' ? text.substr(1, text.size() - 2) : "";
}

using Cells = std::vector<std::string>;

/// Rows of the tables of each section, by its heading.
inline std::map<std::string, std::vector<Cells>> sections(const std::string& page) {
  std::map<std::string, std::vector<Cells>> sections;
  std::istringstream lines(page);
  std::string heading;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) heading = trimmed(line.substr(line.find_first_not_of('#')));
    if (!line.starts_with("|") || line.starts_with("|---")) continue;
    Cells cells;
    std::istringstream row(line.substr(1));
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trimmed(cell));
    sections[heading].push_back(cells);
  }
  return sections;
}

/// The bounds of a cell such as "-1 … 1e3"; none if the cell holds no range.
inline std::optional<std::pair<double, double>> bounds(std::string range) {
  const std::string minus = "−", dots = " … ";
  for (std::size_t at = range.find(minus); at != std::string::npos; at = range.find(minus)) {
    range.replace(at, minus.size(), "-");
  }
  const std::size_t middle = range.find(dots);
  if (middle == std::string::npos) return std::nullopt;
  return std::pair(std::stod(range.substr(0, middle)), std::stod(range.substr(middle + dots.size())));
}

/// The keys that a reader knows at the place of an unknown key, from its error; empty if the error does not name it.
inline std::set<std::string> known_keys(const std::string& problems, const std::string& unknown_key) {
  std::set<std::string> keys;
  const std::string mark = "known here: ";
  const std::size_t error = problems.find(unknown_key + ": unknown key");
  const std::size_t at = error == std::string::npos ? error : problems.find(mark, error);
  if (at == std::string::npos) return keys;
  std::istringstream names(problems.substr(at + mark.size(), problems.find('\n', at) - at - mark.size()));
  for (std::string name; std::getline(names, name, ',');) keys.insert(trimmed(name));
  return keys;
}

}  // namespace boresight::schema_page
