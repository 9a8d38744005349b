// Measured values as text, with as many digits as their standard deviation supports.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace boresight::text {

/// Stands for a value that is not known.
inline constexpr std::string_view kUnknown = "–";

inline constexpr int kMostDecimals = 12;

enum class Sign { kMinusOnly, kAlways };

/// `value` with that many decimals, followed by `unit` ("°", " m/s"). A value that rounds to zero has no minus sign.
/// Not finite: kUnknown.
[[nodiscard]] inline std::string fixed(double value, int decimals, std::string_view unit = {},
                                       Sign sign = Sign::kMinusOnly) {
  if (!std::isfinite(value)) return std::string(kUnknown);
  const std::string number = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool is_zero = number.find_first_not_of("0.") == std::string::npos;
  const bool is_negative = std::signbit(value) && !is_zero;
  const char* const shown_sign = is_negative ? "-" : sign == Sign::kAlways ? "+" : "";
  return fmt::format("{}{}{}", shown_sign, number, unit);
}

/// Number of decimals that shows two significant digits of a standard deviation, 0 to 12. Nothing if the standard
/// deviation is not known, which is stated as zero or as no number.
[[nodiscard]] inline std::optional<int> decimals_for(double std) {
  if (!std::isfinite(std) || std <= 0.0) return std::nullopt;
  // The exponent after rounding: 0.0996 is shown as 0.10, not as 0.100.
  const std::string rounded = fmt::format("{:.1e}", std);
  const int exponent = std::stoi(rounded.substr(rounded.find('e') + 1));
  return std::clamp(1 - exponent, 0, kMostDecimals);
}

/// A value alone, with the decimals of its standard deviation: "+2.512°". Four significant digits where that is not
/// known.
[[nodiscard]] inline std::string rounded(double value, double std, std::string_view unit = {},
                                         Sign sign = Sign::kMinusOnly) {
  const std::optional<int> of_value = decimals_for(std::abs(value));
  const int few = of_value ? std::min(*of_value + 2, kMostDecimals) : 0;
  return fixed(value, decimals_for(std).value_or(few), unit, sign);
}

/// A value with its standard deviation of two significant digits, and the unit once: "+2.512 ± 0.031°". Without the
/// second part where the standard deviation is not known.
[[nodiscard]] inline std::string with_std(double value, double std, std::string_view unit = {},
                                          Sign sign = Sign::kMinusOnly) {
  const std::optional<int> decimals = decimals_for(std);
  if (!decimals || !std::isfinite(value)) return rounded(value, std, unit, sign);
  return fixed(value, *decimals, {}, sign) + " ± " + fixed(std, *decimals, unit);
}

/// An error (estimate − truth) and how many standard deviations it is: "+0.021° (0.5 σ)".
[[nodiscard]] inline std::string error_in_stds(double error, double std, std::string_view unit = {}) {
  const std::string text = rounded(error, std, unit, Sign::kAlways);
  if (!decimals_for(std) || !std::isfinite(error)) return text;
  return text + fmt::format(" ({:.1f} σ)", std::abs(error) / std);
}

/// "308,299".
[[nodiscard]] inline std::string grouped(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

}  // namespace boresight::text
