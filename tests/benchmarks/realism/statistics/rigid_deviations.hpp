// Section 3: range rates of an object's detections against the rigid body.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

struct DeviationSelection {
  RoadUser user = RoadUser::kCar;
  double aspect_from_rad = 0.0, aspect_to_rad = 4.0;
};

class RigidDeviations {
 public:
  void add(const ObservedScan& scan);
  void merge(const RigidDeviations& other);

  /// Detections that deviate by more than `limit_mps`.
  [[nodiscard]] double percent_beyond(const DeviationSelection& of, double limit_mps) const;
  /// Of those beyond 1 m/s: quantile of deviation / radial speed of the body; below 0: slower than the body.
  [[nodiscard]] double ratio(const DeviationSelection& of, double share) const;
  /// Robust standard deviation of those within 0.5 m/s.
  [[nodiscard]] double rest_std_mps(const DeviationSelection& of) const;

 private:
  struct Deviation {
    RoadUser user;
    float aspect_rad, deviation_mps, body_radial_mps;
  };
  template <typename Use>
  void for_each(const DeviationSelection& of, const Use& use) const;
  std::vector<Deviation> all_;
};

}  // namespace boresight::bench::realism
