// How labels look, wherever the page shows them: colours of the Okabe–Ito palette, which most colour-blind people can
// tell apart, and a shape of its own for each.
#pragma once

#include <array>
#include <string>

#include "interfaces/messages/classified_scan.hpp"
#include "services/boresight/report/svg_chart.hpp"

namespace boresight::report {

struct LabelStyle {
  Provenance label;
  const char* words;
  const char* css;   ///< of a symbol
  const char* area;  ///< of a surface
  SvgChart::Shape shape;
};

inline constexpr std::array<LabelStyle, 6> kLabelStyles = {{
    {Provenance::kMoving, "moving", "l1", "l1", SvgChart::Shape::kCircle},
    {Provenance::kStationary, "stationary", "l2", "l2", SvgChart::Shape::kDash},
    {Provenance::kGhostType1, "ghost type 1", "l3", "l3", SvgChart::Shape::kTriangle},
    {Provenance::kGhostType2, "ghost type 2", "l4", "l4", SvgChart::Shape::kDiamond},
    {Provenance::kClutter, "clutter", "l5", "area5", SvgChart::Shape::kCross},
    {Provenance::kUnknown, "told nothing", "l0", "l0", SvgChart::Shape::kSquare},
}};

[[nodiscard]] inline const LabelStyle& style_of(Provenance label) {
  for (const LabelStyle& style : kLabelStyles) {
    if (style.label == label) return style;
  }
  return kLabelStyles.back();
}

[[nodiscard]] inline std::string key_of(const LabelStyle& style) {
  return SvgChart::key(style.shape, style.css) + style.words;
}

}  // namespace boresight::report
