// Alignment estimates received by DDS, as lines for people or for programs.
#pragma once

#include <string>

#include "generated/alignment_estimate.h"

namespace boresight::diagnostics_text {

/// "12:34:56.7 front_right  converged  yaw +2.490 ± 0.021°  pitch … (vehicle's axes)  …"; no line feed at the end.
[[nodiscard]] std::string to_line(const diagnostics::AlignmentEstimate& estimate);
/// A line with line feed: config/schema/json.md.
[[nodiscard]] std::string to_json(const diagnostics::AlignmentEstimate& estimate);

}  // namespace boresight::diagnostics_text
