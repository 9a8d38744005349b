#include "services/boresight/input/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "services/common/estimation/unknown.hpp"

namespace boresight::input {

namespace {

constexpr std::size_t kMaxLine = 4096;

std::string_view trim(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Quotes a text for error messages: shortened, without control characters.
std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongest ? "…\"" : "\"");
}

bool is_named(const Column& column, std::string_view name) {
  const auto& same = column.synonyms;
  return !name.empty() && (column.name == name || std::find(same.begin(), same.end(), name) != same.end());
}

bool is_number(std::string_view text) {
  double unused = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), unused);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

std::int64_t nanoseconds_of(std::string_view text, double value) {
  constexpr std::size_t kDecimals = 9;
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t rounded_ns = std::llround(value * static_cast<double>(kSecond_ns));
  if (text.starts_with('+')) text.remove_prefix(1);
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view decimals = point < text.size() ? text.substr(point + 1) : std::string_view();
  if (decimals.size() > kDecimals) return rounded_ns;
  std::int64_t whole = 0, fraction = 0;
  const auto read = [](std::string_view digits, std::int64_t& number) {
    if (digits.empty()) return true;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc{} && end == digits.data() + digits.size() && digits.front() != '-';
  };
  if (!read(text.substr(0, point), whole) || !read(decimals, fraction)) return rounded_ns;
  constexpr std::int64_t kMost_s = 9'000'000'000;  // as many nanoseconds fit into 64 bits
  if (whole > kMost_s) return rounded_ns;
  for (std::size_t i = decimals.size(); i < kDecimals; ++i) fraction *= 10;
  const std::int64_t magnitude_ns = whole * kSecond_ns + fraction;
  return is_negative ? -magnitude_ns : magnitude_ns;
}

CsvTable::CsvTable(recording::ByteSource& source, std::span<const Column> columns, Problems& problems)
    : source_(source),
      lines_(source, kMaxLine),
      columns_(columns),
      problems_(problems),
      cell_of_(columns.size(), -1),
      offset_of_(columns.size(), 0),
      text_of_(columns.size()) {
  for (const Column& column : columns) name_of_.push_back(column.name);
  std::string expected;
  for (const Column& column : columns) {
    if (column.required) expected += (expected.empty() ? "" : ",") + std::string(column.name);
  }
  std::string_view header;
  if (!next_line(header)) {
    throw TableError(fmt::format("{}: is empty; the first line must name the columns {}", source.name(), expected));
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (header.substr(0, kByteOrderMark.size()) == kByteOrderMark) header.remove_prefix(kByteOrderMark.size());
  if (is_number(trim(header.substr(0, header.find(','))))) {
    throw TableError(
        fmt::format("{}: begins with a number; the first line must name the columns {}", place(0), expected));
  }
  for (std::size_t begin = 0; begin <= header.size();) {
    const std::size_t end = std::min(header.find(',', begin), header.size());
    const std::string_view name = trim(header.substr(begin, end - begin));
    const auto found =
        std::find_if(columns.begin(), columns.end(), [name](const Column& c) { return is_named(c, name); });
    if (found == columns.end()) {
      column_of_.push_back(-1);
      ignored_.emplace_back(quote(name));
    } else {
      const auto column = static_cast<std::size_t>(found - columns.begin());
      if (has(column)) throw TableError(fmt::format("{}: column {} is given twice", place(begin), name));
      cell_of_[column] = static_cast<int>(column_of_.size());
      if (const auto same = std::find(found->synonyms.begin(), found->synonyms.end(), name);
          same != found->synonyms.end()) {
        name_of_[column] = *same;
      }
      column_of_.push_back(static_cast<int>(column));
    }
    begin = end + 1;
  }
  std::string missing;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].required && !has(i)) missing += (missing.empty() ? "" : ", ") + std::string(columns[i].name);
  }
  if (!missing.empty()) {
    throw TableError(fmt::format("{}: the header lacks {}; it must name the columns {} (in any order), and is {}",
                                 place(0), missing, expected, quote(header)));
  }
}

std::string CsvTable::place(std::size_t offset) const {
  return fmt::format("{}:{}:{}", source_.name(), line_number_, offset + 1);
}

bool CsvTable::next_line(std::string_view& line) {
  while (lines_.next(line)) {
    ++line_number_;
    const std::string_view text = trim(line);
    if (!text.empty() && text.front() != '#') return true;
  }
  if (lines_.error() != 0) {
    throw TableError(fmt::format("{}: cannot be read after line {}: {}", source_.name(), line_number_,
                                 std::strerror(lines_.error())));
  }
  return false;
}

bool CsvTable::next(std::span<double> values) {
  for (std::string_view line; next_line(line);) {
    if (parse(line, values)) return true;
  }
  return false;
}

void CsvTable::reject(std::size_t column, const std::string& problem) {
  problems_.bad_line(fmt::format("{}: {}: {}", place(offset_of_[column]), name_of_[column], problem));
}

bool CsvTable::parse(std::string_view line, std::span<double> values) {
  if (line.size() > kMaxLine) {
    problems_.bad_line(fmt::format("{}: longer than {} characters", place(kMaxLine), kMaxLine));
    return false;
  }
  std::fill(values.begin(), values.end(), kNaN);
  std::size_t cell = 0;
  for (std::size_t begin = 0; begin <= line.size(); ++cell) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const int index = cell < column_of_.size() ? column_of_[cell] : -1;
    if (index >= 0) {
      const auto i = static_cast<std::size_t>(index);
      const Column& column = columns_[i];
      std::string_view text = trim(line.substr(begin, end - begin));
      offset_of_[i] = begin;
      text_of_[i] = text;
      if (!column.words.empty()) {
        const auto word = std::find(column.words.begin(), column.words.end(), text);
        if (word == column.words.end()) {
          reject(i, fmt::format("read {}, allowed is nothing or one of {}", quote(text),
                                fmt::join(column.words.begin() + 1, column.words.end(), ", ")));
          return false;
        }
        values[i] = static_cast<double>(word - column.words.begin());
        begin = end + 1;
        continue;
      }
      const auto wrong = [&] {
        reject(i, fmt::format("read {}, allowed is a number {:g} … {:g}{}{}{}", quote(text), column.min, column.max,
                              column.unit.empty() ? "" : " ", column.unit, column.may_be_empty ? ", or nothing" : ""));
      };
      if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
      double value = kNaN;
      if (!text.empty() || !column.may_be_empty) {
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        // A number too small for a double counts as zero.
        const bool is_tiny = error == std::errc::result_out_of_range && text.find("e-") != std::string_view::npos;
        if (is_tiny) value = 0.0;
        if ((error != std::errc{} && !is_tiny) || stop != text.data() + text.size()) return wrong(), false;
      }
      const bool is_allowed = std::isnan(value) ? column.may_be_empty : value >= column.min && value <= column.max;
      if (!is_allowed) return wrong(), false;
      values[i] = value;
    }
    begin = end + 1;
  }
  if (cell != column_of_.size()) {
    problems_.bad_line(
        fmt::format("{}: has {} columns, the header has {}", place(line.size()), cell, column_of_.size()));
    return false;
  }
  return true;
}

}  // namespace boresight::input
