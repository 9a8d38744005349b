// What a classified scan takes over from the corrected one as it is, whatever the method.
#pragma once

#include <cstddef>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/corrected_scan.hpp"

namespace boresight::ghosts {

/// Writes everything of `out` but the header, provenances, probabilities and reflector segments; returns the number of
/// detections.
std::size_t pass_on(const CorrectedScan& scan, ClassifiedScan& out);

}  // namespace boresight::ghosts
