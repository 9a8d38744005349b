// One row of CSV. Numbers are the shortest text that reads back as the same number; what is not known is empty.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>

namespace boresight::run {

class CsvRow {
 public:
  explicit CsvRow(std::string& text) : text_(text) {}

  template <typename Number>
  CsvRow& number(Number value) {
    separate();
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(value)) return *this;
      value += Number{0};  // −0 is written as 0
    }
    std::array<char, kLongestNumber> digits;
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
    return *this;
  }
  template <typename Number>
  CsvRow& number_if(bool is_known, Number value) {
    return is_known ? number(value) : empty();
  }
  CsvRow& empty() {
    separate();
    return *this;
  }
  CsvRow& word(std::string_view value) {
    separate();
    text_ += value;
    return *this;
  }
  /// Seconds with six decimals.
  CsvRow& seconds(std::int64_t us) {
    constexpr std::int64_t kSecond_us = 1'000'000;
    constexpr std::size_t kDecimals = 6;
    separate();
    if (us < 0) text_ += '-';
    std::array<char, kLongestNumber> digits;
    const std::int64_t whole = std::abs(us / kSecond_us);
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), whole).ptr);
    text_ += '.';
    std::int64_t rest = std::abs(us % kSecond_us);
    std::array<char, kDecimals> decimals;
    for (std::size_t i = kDecimals; i > 0; --i, rest /= 10) decimals[i - 1] = static_cast<char>('0' + rest % 10);
    text_.append(decimals.data(), decimals.size());
    return *this;
  }
  void end() { text_ += '\n'; }

 private:
  static constexpr std::size_t kLongestNumber = 32;  // a double or a 64-bit integer is shorter
  void separate() {
    if (!is_first_) text_ += ',';
    is_first_ = false;
  }
  std::string& text_;
  bool is_first_ = true;
};

}  // namespace boresight::run
