// The filter that knows: what the chain behind it makes of perfect labels is what a real method can lose.
#pragma once

#include <vector>

#include "services/ghost_filter/core/method.hpp"
#include "tests/simulator/detection_truth.hpp"

namespace boresight::bench {

class TruthMethod final : public ghosts::Method {
 public:
  /// Of the scan that is classified next; kept by the caller.
  void tell(const std::vector<simulator::DetectionTruth>& truth) { truth_ = &truth; }
  void add_tracks(const TrackList&) override {}
  /// What the corrector calls stationary stays stationary: to say otherwise is not the filter's to do.
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return 0; }

 private:
  const std::vector<simulator::DetectionTruth>* truth_ = nullptr;
};

}  // namespace boresight::bench
