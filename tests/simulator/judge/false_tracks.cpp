#include "tests/simulator/judge/false_tracks.hpp"

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
      // What the tracker never got made no track.
      if (scan.provenance[i] != Provenance::kMoving) continue;
      if (box.distance_m({scan.x_vehicle_m[i], scan.y_vehicle_m[i]}) > kEvidence_m) continue;
      const Provenance is = truth[i].provenance;
      ++(is == Provenance::kGhostType1 || is == Provenance::kGhostType2 ? ghosts
         : is == Provenance::kMoving                                    ? moving
                                                                        : others);
    }
    Life& life = lives_[track.tracking_id];
    const std::size_t all = ghosts + moving + others;
    if (2 * ghosts > all) {
      GhostTrack& its = life.on_ghosts;
      if (its.scans++ == 0) its.since_s = t_s;
      its.tracking_id = track.tracking_id;
      its.until_s = t_s;
      its.x_vehicle_m = track.position_vehicle_m[0];
      its.y_vehicle_m = track.position_vehicle_m[1];
    }
    if (2 * moving > all) ++life.on_moving;
    if (2 * others > all) ++life.on_others;
  }
}

std::vector<GhostTrack> FalseTracks::long_ghost_tracks() const {
  std::vector<GhostTrack> tracks;
  for (const auto& [id, life] : lives_) {
    if (life.on_ghosts.scans > kLong_scans && !life.is_second()) tracks.push_back(life.on_ghosts);
  }
  return tracks;
}

std::size_t FalseTracks::longest_ghost_track_scans() const {
  std::size_t longest = 0;
  for (const auto& [id, life] : lives_) {
    if (!life.is_second()) longest = std::max(longest, life.on_ghosts.scans);
  }
  return longest;
}

std::size_t FalseTracks::long_second_tracks() const {
  return static_cast<std::size_t>(std::count_if(lives_.begin(), lives_.end(), [](const auto& entry) {
    return entry.second.on_moving > kLong_scans && entry.second.is_second();
  }));
}

std::size_t FalseTracks::long_other_tracks() const {
  return static_cast<std::size_t>(std::count_if(
      lives_.begin(), lives_.end(), [](const auto& entry) { return entry.second.on_others > kLong_scans; }));
}

}  // namespace boresight::judge
