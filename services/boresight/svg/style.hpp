// Colours and strokes of everything that is drawn. Each element carries them as attributes, without style sheet or
// variables, so that every viewer shows the same picture.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace boresight::svg {

inline constexpr std::string_view kFonts = "Arial, Helvetica, DejaVu Sans, sans-serif";
inline constexpr std::string_view kPaper = "#ffffff";
inline constexpr std::string_view kInk = "#1c2430";
inline constexpr std::string_view kFaint = "#5c6675";
inline constexpr std::string_view kGridLine = "#d9dee6";
inline constexpr std::string_view kBlue = "#2563b8";
inline constexpr std::string_view kGreen = "#2e8b57";
inline constexpr std::string_view kOrange = "#b87400";
inline constexpr std::string_view kAmber = "#e0a100";
inline constexpr std::string_view kRed = "#c93a3a";
inline constexpr std::string_view kViolet = "#8a3fb0";
inline constexpr std::string_view kGrey = "#8b95a3";
inline constexpr std::string_view kLightGrey = "#b9c1cc";

struct Style {
  std::string_view fill = "none";
  double fill_opacity = 1.0;
  std::string_view stroke = "none";
  double stroke_width_px = 1.0;
  std::string_view dashes = {};  ///< lengths of dash and gap, px
};

[[nodiscard]] constexpr Style line_of(std::string_view colour, double width_px, std::string_view dashes = {}) {
  return {.stroke = colour, .stroke_width_px = width_px, .dashes = dashes};
}
[[nodiscard]] constexpr Style area_of(std::string_view colour, double opacity = 1.0) {
  return {.fill = colour, .fill_opacity = opacity};
}

inline constexpr Style kEstimate = line_of(kBlue, 1.8);
inline constexpr Style kUncertainty = area_of(kBlue, 0.16);
inline constexpr Style kTruth = line_of(kViolet, 1.5, "6 4");
inline constexpr Style kTolerance = line_of(kRed, 1.2, "2 4");
inline constexpr Style kMark = line_of(kFaint, 1.0, "4 3");

/// One colour for each of several curves in a chart.
inline constexpr std::array<std::string_view, 5> kSeries = {kBlue, kGreen, kOrange, kViolet, kRed};
[[nodiscard]] constexpr Style series(std::size_t index) {
  return line_of(kSeries[index % kSeries.size()], 1.6);
}

}  // namespace boresight::svg
