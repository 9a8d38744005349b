// Lines that cannot be understood: the first few are told, all are counted, none stops the work.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace boresight::align {

class Problems {
 public:
  static constexpr std::uint64_t kShown = 10;
  /// `tell` gets one line of text, without its end, for each of the first kShown problems.
  explicit Problems(std::function<void(const std::string&)> tell) : tell_(std::move(tell)) {}

  /// A line that was left out.
  void bad_line(const std::string& text) {
    if (++bad_lines_ <= kShown) tell_(text);
  }
  void good_line() { ++good_lines_; }

  [[nodiscard]] std::uint64_t bad_lines() const { return bad_lines_; }
  /// Of those that hold data: no header, comment or empty line.
  [[nodiscard]] std::uint64_t lines() const { return good_lines_ + bad_lines_; }
  /// More than one line in a hundred is bad: what comes of the rest is not to be relied on.
  [[nodiscard]] bool too_many() const { return bad_lines_ * 100 > lines(); }

 private:
  std::function<void(const std::string&)> tell_;
  std::uint64_t bad_lines_ = 0;
  std::uint64_t good_lines_ = 0;
};

}  // namespace boresight::align
