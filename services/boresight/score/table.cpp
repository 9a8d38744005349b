#include "services/boresight/score/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "services/common/estimation/unknown.hpp"

namespace boresight::score {

namespace {

constexpr std::size_t kLongestLine = 8192;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view without_blanks(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(without_blanks(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

/// A text for an error message: shortened, without control characters.
std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongest ? "…\"" : "\"");
}

}  // namespace

Table::Table(const std::filesystem::path& file, const std::vector<std::string_view>& required_columns)
    : source_(file), lines_(source_, kLongestLine) {
  std::string_view line;
  if (!next_line(line)) throw InputError(fmt::format("{}: is empty; the first line must name the columns", name()));
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  line_ = line;
  split(line_, cells_);
  columns_ = cells_.size();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!cell_of_.emplace(std::string(cells_[i]), i).second) {
      throw InputError(fmt::format("{}:{}: column {} is given twice", name(), line_number_, quoted(cells_[i])));
    }
  }
  for (const std::string_view column : required_columns) {
    if (!has(column)) {
      throw InputError(fmt::format("{}:{}: the header lacks the column {}", name(), line_number_, column));
    }
  }
}

bool Table::next_line(std::string_view& line) {
  while (lines_.next(line)) {
    ++line_number_;
    const std::string_view content = without_blanks(line);
    if (!content.empty() && content.front() != '#') return true;
  }
  if (lines_.error() != 0) {
    throw InputError(
        fmt::format("{}: cannot be read after line {}: {}", name(), line_number_, std::strerror(lines_.error())));
  }
  return false;
}

bool Table::next() {
  std::string_view line;
  if (!next_line(line)) return false;
  if (line.size() > kLongestLine) {
    throw InputError(fmt::format("{}:{}: longer than {} characters", name(), line_number_, kLongestLine));
  }
  line_ = line;
  split(line_, cells_);
  if (cells_.size() != columns_) {
    throw InputError(
        fmt::format("{}:{}: has {} columns, the header has {}", name(), line_number_, cells_.size(), columns_));
  }
  return true;
}

std::string_view Table::text(std::string_view column) const {
  const auto place = cell_of_.find(column);
  return place == cell_of_.end() ? std::string_view{} : cells_[place->second];
}

void Table::refuse(std::string_view column, const std::string& allowed) const {
  throw InputError(
      fmt::format("{}:{}: {}: read {}, allowed is {}", name(), line_number_, column, quoted(text(column)), allowed));
}

double Table::number(std::string_view column, double min, double max) const {
  std::string_view cell = text(column);
  if (cell.size() > 1 && cell.front() == '+') cell.remove_prefix(1);
  double value = kNaN;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !(value >= min && value <= max)) {
    refuse(column, fmt::format("a number {:g} … {:g}", min, max));
  }
  return value;
}

double Table::number_or_nan(std::string_view column, double min, double max) const {
  const std::string_view cell = text(column);
  return cell.empty() || cell == "nan" ? kNaN : number(column, min, max);
}

std::int64_t Table::integer(std::string_view column, std::int64_t min, std::int64_t max) const {
  const std::string_view cell = text(column);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || value < min || value > max) {
    refuse(column, fmt::format("a whole number {} … {}", min, max));
  }
  return value;
}

std::vector<std::string> header_of(const std::filesystem::path& file) {
  std::vector<std::string> names;
  recording::ByteSource source(file);
  recording::LineReader lines(source, kLongestLine);
  for (std::string_view line; lines.next(line);) {
    const std::string_view content = without_blanks(line);
    if (content.empty() || content.front() == '#') continue;
    std::string header(content);
    if (header.starts_with(kByteOrderMark)) header.erase(0, kByteOrderMark.size());
    std::vector<std::string_view> cells;
    split(header, cells);
    for (const std::string_view cell : cells) names.emplace_back(cell);
    break;
  }
  return names;
}

}  // namespace boresight::score
