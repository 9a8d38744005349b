// A ghost filter with perfect labels from the truth: the tracker's result with it is the reference for lost objects.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "services/ghost_filter/core/method.hpp"
#include "services/simulator/detection_truth.hpp"

namespace boresight::bench {

class TruthMethod final : public ghosts::Method {
 public:
  TruthMethod() = default;
  /// A random share (0 … 1) of the moving detections, the same for all objects, is labelled as ghosts.
  TruthMethod(double mislabelled_share, std::uint64_t seed) : mislabelled_share_(mislabelled_share), random_(seed) {}
  /// Truth of the scan that is classified next; the caller keeps it alive.
  void set_truth(const std::vector<simulator::DetectionTruth>& truth) { truth_ = &truth; }
  void add_tracks(const TrackList&) override {}
  /// Detections that the corrector classified as stationary stay stationary: a filter does not change them.
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return 0; }

 private:
  [[nodiscard]] bool is_mislabelled();
  const std::vector<simulator::DetectionTruth>* truth_ = nullptr;
  double mislabelled_share_ = 0.0;
  std::mt19937_64 random_;
};

}  // namespace boresight::bench
