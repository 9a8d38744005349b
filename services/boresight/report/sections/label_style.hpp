// How labels look, wherever the page shows them: colours of the Okabe–Ito palette, which most colour-blind people can
// distinguish, and a shape of its own for each.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "interfaces/messages/classified_scan.hpp"
#include "services/boresight/svg/chart.hpp"

namespace boresight::report {

struct LabelStyle {
  Provenance label;
  const char* words;
  std::string_view colour;
  svg::Shape shape;
  bool is_outline;  ///< shapes without a surface
  [[nodiscard]] constexpr svg::Style symbol() const {
    return is_outline ? svg::line_of(colour, 1.6) : svg::area_of(colour);
  }
  [[nodiscard]] constexpr svg::Style area() const { return svg::area_of(colour); }
};

inline constexpr std::array<LabelStyle, kNumberOfProvenances> kLabelStyles = {{
    {Provenance::kMoving, "moving", "#0072b2", svg::Shape::kCircle, false},
    {Provenance::kStationary, "stationary", svg::kGrey, svg::Shape::kDash, true},
    {Provenance::kGhostType1, "ghost type 1", "#d98200", svg::Shape::kTriangle, false},
    {Provenance::kGhostType2, "ghost type 2", "#b8478f", svg::Shape::kDiamond, false},
    {Provenance::kClutter, "clutter", "#00805f", svg::Shape::kCross, true},
    {Provenance::kAmbiguity, "ambiguity", "#3a9bd0", svg::Shape::kSquare, false},
    {Provenance::kUnknown, "not classified", svg::kInk, svg::Shape::kSquare, true},
}};

[[nodiscard]] inline const LabelStyle& style_of(Provenance label) {
  for (const LabelStyle& style : kLabelStyles) {
    if (style.label == label) return style;
  }
  return kLabelStyles.back();
}

[[nodiscard]] inline std::string key_of(const LabelStyle& style) {
  return svg::page_key(svg::symbol_sample(style.shape, style.symbol())) + style.words;
}

}  // namespace boresight::report
