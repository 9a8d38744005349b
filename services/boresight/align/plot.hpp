// A result as a picture.
#pragma once

#include <string>

#include "services/boresight/align/result.hpp"

namespace boresight::align {

/// An SVG that needs nothing else, readable on light and dark ground: every parameter over time with ±2 σ, the truth
/// where known, knocks, and each radar's residuals before and after.
[[nodiscard]] std::string to_svg(const Result& result);

}  // namespace boresight::align
