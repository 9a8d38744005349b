// Confirmed tracks that are no object's.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "tests/benchmarks/ghosts/common/matching.hpp"
#include "tests/simulator/detection_truth.hpp"

namespace boresight::bench {

class FalseTracks {
 public:
  static constexpr std::size_t kLong_scans = 5;

  /// A track counts as living on ghosts in a scan in which it is confirmed, has detections, is no object's
  /// (matching.hpp), and most of what lies within kEvidence_m of its box and was told to be moving is a ghost in truth.
  static constexpr double kEvidence_m = 2.0;
  void add(const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth, const TrackList& tracks,
           const Matching& matching);

  /// That lived on ghosts for more than kLong_scans scans, in a row or not.
  [[nodiscard]] std::size_t long_ghost_tracks() const { return number_of_long(&Scans::on_ghosts); }
  [[nodiscard]] std::size_t longest_ghost_track_scans() const;
  /// The same of what is neither a ghost nor moving: clutter, or the stationary world.
  [[nodiscard]] std::size_t long_other_tracks() const { return number_of_long(&Scans::on_others); }

 private:
  struct Scans {
    std::size_t on_ghosts = 0, on_others = 0;
  };
  [[nodiscard]] std::size_t number_of_long(std::size_t Scans::*what) const;
  std::map<std::uint32_t, Scans> scans_;  // by track
};

}  // namespace boresight::bench
