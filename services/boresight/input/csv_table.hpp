// Tables of numbers with a header line: columns by name in any order, each number checked against its allowed range.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "services/boresight/input/problems.hpp"
#include "services/common/recording/byte_source.hpp"
#include "services/common/recording/line_reader.hpp"

namespace boresight::input {

/// The whole file cannot be used; what() names file, line and cause.
class TableError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A column that is read if the table contains it.
struct Column {
  std::string_view name;  ///< of the documentation
  double min, max;        ///< of allowed values
  std::string_view unit;
  bool required = true;                           ///< false: the table need not contain it
  bool may_be_empty = false;                      ///< an empty cell or "nan" is read as NaN
  std::array<std::string_view, 2> synonyms = {};  ///< other names of the same column
  std::span<const std::string_view> words = {};   ///< instead of numbers; the value is the index of the word
};

/// A decimal number times 1e9, exactly if it has at most nine decimals and no exponent. `value` is the same number, for
/// other texts.
[[nodiscard]] std::int64_t nanoseconds_of(std::string_view text, double value);

class CsvTable {
 public:
  /// Reads the header; throws TableError if there is none, or if a required column is missing or given twice. Skips
  /// empty lines and comments ('#'). `columns` must outlive the table.
  CsvTable(recording::ByteSource& source, std::span<const Column> columns, Problems& problems);

  /// The next row's values in the order of `columns`, NaN for an absent or empty cell. Rows that cannot be read are
  /// reported to `problems` and skipped. False at the end; throws TableError after a read error.
  [[nodiscard]] bool next(std::span<double> values);

  /// Counts the row that next() returned last as bad.
  void reject(std::size_t column, const std::string& problem);
  /// Counts the row that next() returned last as good.
  void accept() { problems_.good_line(); }

  [[nodiscard]] bool has(std::size_t column) const { return cell_of_[column] >= 0; }
  /// The text of a number in the row that next() returned last; valid until the next call.
  [[nodiscard]] std::string_view text(std::size_t column) const { return text_of_[column]; }
  /// Names of the table's columns that are not read.
  [[nodiscard]] const std::vector<std::string>& ignored() const { return ignored_; }
  [[nodiscard]] std::uint64_t line_number() const { return line_number_; }

 private:
  [[nodiscard]] bool next_line(std::string_view& line);
  [[nodiscard]] bool parse(std::string_view line, std::span<double> values);
  [[nodiscard]] std::string place(std::size_t offset) const;

  recording::ByteSource& source_;
  recording::LineReader lines_;
  std::span<const Column> columns_;
  Problems& problems_;
  std::vector<int> cell_of_;            // by column: which cell, −1: none
  std::vector<int> column_of_;          // by cell: which column, −1: ignored
  std::vector<std::size_t> offset_of_;  // by column: where its text begins in the line
  std::vector<std::string_view> text_of_;
  std::vector<std::string_view> name_of_;  // by column: as the table names it
  std::vector<std::string> ignored_;
  std::uint64_t line_number_ = 0;
};

}  // namespace boresight::input
