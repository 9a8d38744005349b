// Confirmed tracks that match no object, by the true origin of their detections: what the bars of docs/ghosts.md judge,
// and the findings of the demo's report. The track judge counts false tracks whatever their cause.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/simulator/detection_truth.hpp"
#include "services/simulator/judge/matching.hpp"

namespace boresight::judge {

/// A confirmed track that lived on ghosts, with its position and time when it last did.
struct GhostTrack {
  std::uint32_t tracking_id;
  std::size_t scans;
  double since_s, until_s;
  double x_vehicle_m, y_vehicle_m;
};

class FalseTracks {
 public:
  static constexpr std::size_t kMaxTolerated_scans = 5;

  /// A confirmed track lives on ghosts in a scan if it has detections, matches no object (matching.hpp), and most
  /// detections near its box are ghosts in truth. Counted are detections within kEvidenceDistance_m of the box that
  /// were classified as moving.
  static constexpr double kEvidenceDistance_m = 2.0;
  void add(double t_s, const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth,
           const TrackList& tracks, const Matching& matching);

  /// Tracks that lived on ghosts for more than kMaxTolerated_scans scans, consecutive or not.
  [[nodiscard]] std::vector<GhostTrack> long_ghost_tracks() const;
  [[nodiscard]] std::size_t longest_ghost_track_scans() const;
  /// Number of tracks that lived on clutter or stationary detections for more than kMaxTolerated_scans scans.
  [[nodiscard]] std::size_t long_other_tracks() const;

 private:
  std::map<std::uint32_t, GhostTrack> on_ghosts_;
  std::map<std::uint32_t, std::size_t> on_others_;  // scans
};

}  // namespace boresight::judge
