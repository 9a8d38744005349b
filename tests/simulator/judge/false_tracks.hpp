// Confirmed tracks that are no object's.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "tests/simulator/detection_truth.hpp"
#include "tests/simulator/judge/matching.hpp"

namespace boresight::judge {

/// A confirmed track that lived on ghosts, where and when it did so last.
struct GhostTrack {
  std::uint32_t tracking_id;
  std::size_t scans;
  double since_s, until_s;
  double x_vehicle_m, y_vehicle_m;
};

class FalseTracks {
 public:
  static constexpr std::size_t kMaxTolerated_scans = 5;

  /// A track counts as living on ghosts in a scan in which it is confirmed, has detections, is no object's
  /// (matching.hpp), and most of what lies within kEvidenceDistance_m of its box and was told to be moving is a ghost
  /// in truth.
  static constexpr double kEvidenceDistance_m = 2.0;
  void add(double t_s, const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth,
           const TrackList& tracks, const Matching& matching);

  /// That lived on ghosts for more than kMaxTolerated_scans scans, in a row or not.
  [[nodiscard]] std::vector<GhostTrack> long_ghost_tracks() const;
  [[nodiscard]] std::size_t longest_ghost_track_scans() const;
  /// The number of those of what is neither a ghost nor moving: clutter, or the stationary world.
  [[nodiscard]] std::size_t long_other_tracks() const;

 private:
  std::map<std::uint32_t, GhostTrack> on_ghosts_;
  std::map<std::uint32_t, std::size_t> on_others_;  // scans
};

}  // namespace boresight::judge
