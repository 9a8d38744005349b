// The truth of an alignment drive as text.
#pragma once

#include <string>

#include "services/simulator/alignment/bound.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight::simulator {

/// RMSE of the range rates of stationary detections (m/s).
struct AlignmentResiduals {
  double uncorrected_mps, at_truth_mps;
};

/// Lines of a key and pairs of name and value, angles in degrees: k_v; one line per radar with α, β, γ at the start;
/// noise; disturbance; the effects of a real car, one a line; one line per step change with α, β, γ after it;
/// residuals; and the bound if there is one.
[[nodiscard]] std::string truth_text(const AlignmentSpec& spec, const AlignmentDrive& drive,
                                     const AlignmentResiduals& residuals, const CramerRaoBound* bound);

}  // namespace boresight::simulator
