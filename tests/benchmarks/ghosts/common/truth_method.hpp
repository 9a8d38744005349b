// The filter that knows: what the chain behind it makes of perfect labels is what a real method can lose.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "services/ghost_filter/core/method.hpp"
#include "tests/simulator/detection_truth.hpp"

namespace boresight::bench {

class TruthMethod final : public ghosts::Method {
 public:
  TruthMethod() = default;
  /// Such a share of what moves is thrown out by chance, as likely of one object as of another: 0 … 1.
  TruthMethod(double thrown_out, std::uint64_t seed) : thrown_out_(thrown_out), random_(seed) {}
  /// Of the scan that is classified next; kept by the caller.
  void tell(const std::vector<simulator::DetectionTruth>& truth) { truth_ = &truth; }
  void add_tracks(const TrackList&) override {}
  /// What the corrector calls stationary stays stationary: to say otherwise is not the filter's to do.
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return 0; }

 private:
  [[nodiscard]] bool is_thrown_out();
  const std::vector<simulator::DetectionTruth>* truth_ = nullptr;
  double thrown_out_ = 0.0;
  std::mt19937_64 random_;
};

}  // namespace boresight::bench
