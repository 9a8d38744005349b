// Section 1: where vehicles are first and last detected.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

/// First and last detections of moving cars and trucks by any radar. As the tracks of Schumann et al., an object counts
/// with at least 30 detections. A first detection in the first second of a drive, or a last one in its last second, is
/// due to the drive and does not count.
class Births {
 public:
  void add(const ObservedScan& scan);
  /// Ends a drive: object numbers begin again.
  void end_drive();
  void merge(const Births& other);

  /// Ranges of the first detections.
  [[nodiscard]] const Samples& first_range_m(RoadUser user) const {
    return first_range_m_[static_cast<std::size_t>(user)];
  }
  /// Within 6 m of the largest range.
  [[nodiscard]] double percent_first_at_largest_range() const { return first_far_.percent(); }
  [[nodiscard]] double percent_last_at_largest_range() const { return last_far_.percent(); }
  /// Last ones within 6° of the edge of the field of view.
  [[nodiscard]] double percent_last_at_edge() const { return last_edge_.percent(); }
  /// First and last ones that are neither at the largest range nor at the edge.
  [[nodiscard]] double percent_elsewhere() const { return elsewhere_.percent(); }

 private:
  struct Place {
    double t_s, range_m;
    bool is_far, is_at_edge;
  };
  struct Life {
    RoadUser user;
    Place first, last;
    std::size_t detections;
  };
  std::map<std::uint32_t, Life> lives_;  // by object
  double begin_s_ = kNoFigure, end_s_ = kNoFigure;
  std::array<Samples, kRoadUsers> first_range_m_;
  Share first_far_, last_far_, last_edge_, elsewhere_;
};

}  // namespace boresight::bench::realism
