#include "tests/benchmarks/ghosts/common/truth_method.hpp"

#include "services/ghost_filter/core/pass_on.hpp"

namespace boresight::bench {

bool TruthMethod::is_mislabelled() {
  // The standard library's distributions differ between implementations.
  return static_cast<double>(random_() >> 11U) * 0x1p-53 < mislabelled_share_;
}

void TruthMethod::classify(const CorrectedScan& scan, ClassifiedScan& out) {
  const std::size_t count = ghosts::pass_on(scan, out);
  out.number_of_reflector_segments = 0;
  for (std::size_t i = 0; i < count; ++i) {
    out.set_certain(i, Provenance::kUnknown);
    if ((scan.detection_flags[i] & corrected_flag::kRejected) != 0) continue;
    if ((scan.detection_flags[i] & corrected_flag::kMoving) == 0) {
      out.set_certain(i, Provenance::kStationary);
      continue;
    }
    const Provenance truth = (*truth_)[i].provenance;
    out.set_certain(i, truth == Provenance::kMoving && is_mislabelled() ? Provenance::kGhostType1 : truth);
  }
}

}  // namespace boresight::bench
