// Confusion matrix: the true provenance of detections against their classification.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/classified_scan.hpp"

namespace boresight::judge {

class Confusion {
 public:
  /// `rejected`: the corrector rejected the detection (invalid, weak, outside of the region). It is counted separately.
  void add(Provenance truth, Provenance label, bool rejected);

  /// Detections of this true provenance, without the rejected ones.
  [[nodiscard]] std::uint64_t count(Provenance truth) const;
  [[nodiscard]] std::uint64_t count(Provenance truth, Provenance label) const {
    return counts_[index(truth)][index(label)];
  }
  [[nodiscard]] std::uint64_t rejected(Provenance truth) const { return rejected_[index(truth)]; }
  /// Percent of count(truth) that got this label; NaN if the count is 0.
  [[nodiscard]] double percent(Provenance truth, Provenance label) const;
  /// Percent classified as a ghost of either type.
  [[nodiscard]] double percent_ghost(Provenance truth) const {
    return percent(truth, Provenance::kGhostType1) + percent(truth, Provenance::kGhostType2);
  }

 private:
  static constexpr std::size_t kSize = kNumberOfProvenances;
  static std::size_t index(Provenance provenance);
  std::array<std::array<std::uint64_t, kSize>, kSize> counts_{};
  std::array<std::uint64_t, kSize> rejected_{};
};

}  // namespace boresight::judge
