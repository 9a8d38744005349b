// Section 6: what the false movers are, by the measured definitions. They overlap, and chance fulfils them, too.
#pragma once

#include <array>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

class FalseMoverOrigins {
 public:
  void add(const ObservedScan& scan);
  void merge(const FalseMoverOrigins& other);

  [[nodiscard]] double percent_beside_tracked_object() const { return beside_tracked_.percent(); }
  /// Behind an object at its range rate, and the same 10° beside its direction (mean of either side).
  [[nodiscard]] double percent_behind_object() const { return behind_.percent(); }
  [[nodiscard]] double percent_beside_behind_object() const { return beside_behind_.percent(); }
  [[nodiscard]] double percent_at_twice_the_range() const { return twice_.percent(); }
  [[nodiscard]] double percent_rest_of_object() const { return rest_.percent(); }
  /// None of these, no Doppler ambiguity, and no azimuth ambiguity.
  [[nodiscard]] double percent_of_no_origin() const { return none_.percent(); }
  /// Mirror images of type 2, by the truth.
  [[nodiscard]] double percent_mirror_images() const { return mirror_images_.percent(); }
  /// Distance of sin(azimuth) between false movers and stationary detections of their range and range rate that is the
  /// most frequent, against the mean of the distances 0.2 less and more.
  [[nodiscard]] double sine_step() const;

 private:
  static constexpr double kSineBin = 0.04;
  static constexpr std::size_t kSineBins = 50;  // up to 2
  Share beside_tracked_, behind_, beside_behind_, twice_, rest_, none_, mirror_images_;
  std::array<std::size_t, kSineBins> sine_distances_{};
};

}  // namespace boresight::bench::realism
