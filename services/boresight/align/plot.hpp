// A result as a picture.
#pragma once

#include <string>

#include "services/boresight/align/result.hpp"

namespace boresight::align {

/// An SVG: every parameter over time with ±2 σ, the truth where known, sudden misalignments, and the residuals of each
/// radar with the nominal mounting and with the estimate.
[[nodiscard]] std::string to_svg(const Result& result);

}  // namespace boresight::align
