// Reads a table of text row by row: columns by name in any order, unknown columns ignored, numbers checked against
// their allowed range. A judge accepts no damaged table: the first cell that cannot be read is an error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/recording/byte_source.hpp"
#include "services/common/recording/line_reader.hpp"

namespace boresight::score {

/// A file of a run or of a truth that cannot be used; what() names file, line, column, value and what is allowed.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Table {
 public:
  /// Reads the header. Throws InputError if the file cannot be read or lacks one of the columns.
  Table(const std::filesystem::path& file, const std::vector<std::string_view>& required_columns);

  /// Whether the header names this column.
  [[nodiscard]] bool has(std::string_view column) const { return cell_of_.contains(column); }
  /// Goes to the next row; false at the end. Throws InputError for a row with too few or too many cells.
  [[nodiscard]] bool next();

  /// A cell of the present row; empty if there is no such column.
  [[nodiscard]] std::string_view text(std::string_view column) const;
  /// A number within the allowed range; InputError otherwise.
  [[nodiscard]] double number(std::string_view column, double min, double max) const;
  /// NaN for an empty cell or an absent column.
  [[nodiscard]] double number_or_nan(std::string_view column, double min, double max) const;
  [[nodiscard]] std::int64_t integer(std::string_view column, std::int64_t min, std::int64_t max) const;
  /// Throws InputError for a cell of the present row.
  [[noreturn]] void refuse(std::string_view column, const std::string& allowed) const;

  [[nodiscard]] const std::string& name() const { return source_.name(); }

 private:
  [[nodiscard]] bool next_line(std::string_view& line);

  recording::ByteSource source_;
  recording::LineReader lines_;
  std::map<std::string, std::size_t, std::less<>> cell_of_;
  std::size_t columns_ = 0;
  std::string line_;
  std::vector<std::string_view> cells_;
  std::uint64_t line_number_ = 0;
};

/// Names of the columns of a table; empty if the file cannot be read or is empty.
[[nodiscard]] std::vector<std::string> header_of(const std::filesystem::path& file);

}  // namespace boresight::score
