// Origins of detections as a perfect ghost filter would state them.
#pragma once

#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/boresight/score/detection_truth.hpp"

namespace boresight::bench::tracking {

/// Probability 1 for the true origin of each detection, by index. Detections without classification keep none: they are
/// rejected, or the ego motion is unknown. What the corrector found is not changed.
void set_true_origins(const std::vector<score::TrueOrigin>& origins, ClassifiedScan& scan);

}  // namespace boresight::bench::tracking
