// The fields of a record's line, words between blanks, and the error of the first field that cannot be read.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>

#include "services/boresight/monitor/damaged_lines.hpp"

namespace boresight::monitor {

/// The allowed numbers, as errors state them.
template <typename T>
std::string allowed_numbers(T most = std::numeric_limits<T>::max()) {
  if constexpr (std::is_floating_point_v<T>) return "a number";
  return fmt::format("a whole number from {} to {}", std::numeric_limits<T>::min(), most);
}

/// Whether all of the word is a number of this type.
template <typename T>
bool parse(std::string_view word, T& value) {
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  return result.ec == std::errc() && result.ptr == word.data() + word.size();
}

/// The words of a line, up to the first that is missing or not allowed.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  [[nodiscard]] bool ok() const { return error_.empty(); }
  [[nodiscard]] const std::string& error() const { return error_; }
  /// The fields that follow belong to this one of a list; it counts from 0, errors from 1.
  void item(std::string_view what, std::size_t index) {
    item_ = what;
    index_ = index;
  }
  void no_item() { item_ = {}; }
  [[nodiscard]] std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }
  template <typename T>
  void read(std::string_view field, T& value) {
    const std::string_view text = word();
    if (!parse(text, value)) refuse(field, text, allowed_numbers<T>());
  }
  /// 0 where it is not allowed.
  [[nodiscard]] std::uint32_t at_most(std::string_view field, std::size_t most) {
    const std::string_view text = word();
    std::uint32_t value = 0;
    if (parse(text, value) && value <= most) return value;
    refuse(field, text, allowed_numbers(most));
    return 0;
  }
  /// One of an enumeration's values, which count from 0 to `last`.
  template <typename Enum>
  [[nodiscard]] Enum value(std::string_view field, Enum last) {
    return static_cast<Enum>(at_most(field, static_cast<std::size_t>(last)));
  }
  /// Any word.
  [[nodiscard]] std::string text(std::string_view field) {
    const std::string_view text = word();
    if (text.empty()) refuse(field, text, {});
    return std::string(text);
  }
  [[nodiscard]] bool more() const { return rest_.find_first_not_of(' ') != std::string_view::npos; }
  void refuse(std::string_view field, std::string_view word, std::string_view allowed) {
    if (!ok()) return;
    const std::string whose = item_.empty() ? std::string(field) : fmt::format("{} of {} {}", field, item_, index_ + 1);
    error_ = word.empty() ? fmt::format("ends before {}", whose)
                          : fmt::format("{} is {}, allowed: {}", whose, quoted(word), allowed);
  }
  /// Checks that only the closing mark is left.
  void close() {
    no_item();
    const std::string_view last = word();
    if (last != "." || !rest_.empty()) refuse("its end", last == "." ? rest_ : last, "'.'");
  }

 private:
  std::string_view rest_, item_;
  std::size_t index_ = 0;
  std::string error_;
};

}  // namespace boresight::monitor
