// Section 6: strength of false movers that repeat an object's range and range rate, against this object.
#pragma once

#include <array>
#include <cstddef>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

/// Pairs of the strongest detection of a moving object and a false mover of the same scan within 3 m of its range and
/// 0.6 m/s of its range rate, over 8° beside it. Pairs by chance are those at range rates 3 m/s beside the object's: an
/// earlier scan would not do, since it holds ghosts of the same object.
class GhostStrength {
 public:
  void add(const ObservedScan& scan);
  void merge(const GhostStrength& other);

  /// Quantile of the false mover's RCS less the object's, with the pairs by chance taken off.
  [[nodiscard]] double quantile_db(double share) const;
  [[nodiscard]] double percent_stronger() const;
  /// The same quantile of mirror images by the truth.
  [[nodiscard]] double mirror_image_quantile_db(double share) const { return mirror_images_db_.quantile(share); }
  [[nodiscard]] std::size_t pairs() const;

 private:
  static constexpr int kReach_db = 80;
  using Histogram = std::array<double, 2 * kReach_db + 1>;  // by 1 dB
  [[nodiscard]] Histogram without_chance() const;

  Histogram pairs_{}, by_chance_{};  // chance: the mean of either side
  Samples mirror_images_db_;
};

}  // namespace boresight::bench::realism
