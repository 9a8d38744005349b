// Section 2: where on the body the detections lie.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

class BodyPlaces {
 public:
  void add(const ObservedScan& scan);
  /// Ends a drive: object numbers begin again.
  void end_drive();
  void merge(const BodyPlaces& other);

  struct Figures {
    Samples depth_m;           ///< inside the box, negative outside
    Samples shown_length_m;    ///< along the body, of scans with at least three detections of it
    Samples shown_width_m;     ///< across, likewise
    Samples behind_nearest_m;  ///< range beyond the nearest detection of the object in the scan
    WithinGroups across_m;     ///< about the mean of one object and radar
    Samples across_from_mean_m;
  };
  [[nodiscard]] const Figures& of(RoadUser user) const { return figures_[static_cast<std::size_t>(user)]; }

 private:
  std::array<Figures, kRoadUsers> figures_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<RoadUser, std::vector<double>>> across_m_;
};

}  // namespace boresight::bench::realism
