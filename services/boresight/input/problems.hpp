// Counts lines that cannot be read. The first few are reported; none stops the work.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace boresight::input {

class Problems {
 public:
  static constexpr std::uint64_t kShown = 10;
  /// Calls `report` with a line of text, without line feed, for each of the first kShown problems.
  explicit Problems(std::function<void(const std::string&)> report) : report_(std::move(report)) {}

  /// Counts a line that is skipped.
  void bad_line(const std::string& text) {
    if (++bad_lines_ <= kShown) report_(text);
  }
  void good_line() { ++good_lines_; }

  [[nodiscard]] std::uint64_t bad_lines() const { return bad_lines_; }
  /// Lines with data, without header, comments and empty lines.
  [[nodiscard]] std::uint64_t lines() const { return good_lines_ + bad_lines_; }
  /// More than one line in a hundred is bad: the result is doubtful.
  [[nodiscard]] bool too_many() const { return bad_lines_ * 100 > lines(); }

 private:
  std::function<void(const std::string&)> report_;
  std::uint64_t bad_lines_ = 0;
  std::uint64_t good_lines_ = 0;
};

}  // namespace boresight::input
