#include "services/simulator/judge/false_tracks.hpp"

#include <algorithm>

namespace boresight::judge {

void FalseTracks::add(double t_s, const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth,
                      const TrackList& tracks, const Matching& matching) {
  for (std::size_t k = 0; k < matching.object_of_track.size(); ++k) {
    const Track& track = tracks.tracks[k];
    if (matching.object_of_track[k] != kNone || track.number_of_detections == 0) continue;
    const Object box{track.tracking_id, place_of(track), {0.0, 0.0}, track.heading_rad, track.length_m, track.width_m};
    std::size_t ghosts = 0, moving = 0, others = 0;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      // The tracker gets only detections classified as moving.
      if (scan.provenance[i] != Provenance::kMoving) continue;
      if (box.distance_m({scan.x_vehicle_m[i], scan.y_vehicle_m[i]}) > kEvidenceDistance_m) continue;
      const Provenance is = truth[i].provenance;
      ++(is == Provenance::kGhostType1 || is == Provenance::kGhostType2 ? ghosts
         : is == Provenance::kMoving                                    ? moving
                                                                        : others);
    }
    if (2 * ghosts > ghosts + moving + others) {
      GhostTrack& its =
          on_ghosts_.try_emplace(track.tracking_id, GhostTrack{track.tracking_id, 0, t_s, t_s, 0.0, 0.0}).first->second;
      ++its.scans;
      its.until_s = t_s;
      its.x_vehicle_m = track.position_vehicle_m[0];
      its.y_vehicle_m = track.position_vehicle_m[1];
    }
    if (2 * others > ghosts + moving + others) ++on_others_[track.tracking_id];
  }
}

std::vector<GhostTrack> FalseTracks::long_ghost_tracks() const {
  std::vector<GhostTrack> tracks;
  for (const auto& [id, track] : on_ghosts_) {
    if (track.scans > kMaxTolerated_scans) tracks.push_back(track);
  }
  return tracks;
}

std::size_t FalseTracks::longest_ghost_track_scans() const {
  std::size_t longest = 0;
  for (const auto& [id, track] : on_ghosts_) longest = std::max(longest, track.scans);
  return longest;
}

std::size_t FalseTracks::long_other_tracks() const {
  return static_cast<std::size_t>(std::count_if(on_others_.begin(), on_others_.end(),
                                                [](const auto& entry) { return entry.second > kMaxTolerated_scans; }));
}

}  // namespace boresight::judge
