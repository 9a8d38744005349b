#include "tests/benchmarks/ghosts/common/changed_method.hpp"

#include <cmath>

namespace boresight::bench {

ChangedMethod::ChangedMethod(const ghosts::Config& config, const Change& change)
    : change_(change), method_(ghosts::make_method(config)) {}

void ChangedMethod::add_tracks(const TrackList& tracks) {
  if (change_.gets_tracks) method_->add_tracks(tracks);
}

const CorrectedScan& ChangedMethod::changed(const CorrectedScan& scan) {
  constexpr std::uint16_t kMotionFlags = corrected_flag::kMoving | corrected_flag::kStationary;
  if (change_.gets_rcs && !change_.stationary_below_mps) return scan;
  *scan_ = scan;
  if (!change_.gets_rcs) scan_->fields &= ~scan_field::kRcs;
  if (change_.stationary_below_mps) {
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      std::uint16_t& flags = scan_->detection_flags[i];
      if ((flags & kMotionFlags) == 0) continue;
      const bool moves =
          std::abs(static_cast<double>(scan.range_rate_over_ground_mps[i])) >= *change_.stationary_below_mps;
      flags = static_cast<std::uint16_t>((flags & ~kMotionFlags) |
                                         (moves ? corrected_flag::kMoving : corrected_flag::kStationary));
    }
  }
  return *scan_;
}

void ChangedMethod::classify(const CorrectedScan& scan, ClassifiedScan& out) {
  method_->classify(changed(scan), out);
  if (change_.passes_probabilities) return;
  for (std::size_t i = 0; i < out.number_of_valid_detections; ++i) out.set_certain(i, out.provenance[i]);
}

}  // namespace boresight::bench
