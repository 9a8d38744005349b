// Quality of the tracks of a simulated drive, judged by the truth.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "services/simulator/judge/hidden.hpp"
#include "services/simulator/judge/matching.hpp"
#include "tests/closed_loop/chain.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::closed_loop {

/// Largest distance of an object's centre from the ego vehicle that four corner radars shall cover.
constexpr double kFarthest_m = 60.0;
using judge::kHidden_s;
using judge::kMaxTrackDistance_m;
/// The alignment estimator starts without stored estimates here and needs more than 1 s to find a mounting error
/// of 2.5°. False tracks caused meanwhile are counted separately.
constexpr double kAligned_s = 1.5;

struct Figures {
  std::size_t scans = 0;
  /// Stays: intervals of more than 3 s in which an object is within reach, from its first detection until it leaves or
  /// is hidden. `worst_delay_s`: longest time from the start of a stay to a confirmed track.
  std::size_t stays = 0, stays_found = 0;
  double worst_delay_s = 0.0;
  std::size_t chances = 0, found = 0;  ///< scans of stays after 1.5 s; of these, with a confirmed track
  std::size_t switches = 0;            ///< changes of the track's id during a stay
  std::size_t twice = 0;               ///< second and further confirmed tracks at an object, summed over scans
  std::size_t ids = 0;
  /// False tracks: confirmed tracks that are at no object in most of their scans. `early`: those that began before
  /// kAligned_s. `scans`: number of scans with a track at no object.
  std::size_t false_ids = 0, early_false_ids = 0, false_scans = 0, early_false_scans = 0;
  /// Errors of the track nearest to an object.
  double along_rms_m = 0.0, across_rms_m = 0.0, velocity_rms_mps = 0.0, heading_rms_rad = 0.0;
  double length_bias_m = 0.0, width_bias_m = 0.0;

  [[nodiscard]] double share() const { return static_cast<double>(found) / static_cast<double>(chances); }
  [[nodiscard]] double false_tracks() const { return static_cast<double>(false_scans) / static_cast<double>(scans); }
  [[nodiscard]] double twice_tracks() const { return static_cast<double>(twice) / static_cast<double>(scans); }
};

/// Computes the figures of one drive.
class Judge {
 public:
  /// After each scan.
  void add(double t_s, const Chain& chain, const std::vector<simulator::DetectionTruth>& truth,
           const std::vector<Object>& objects);
  [[nodiscard]] Figures finish(double t_s);

 private:
  struct Stay {
    double since_s = -1.0, seen_s = -1.0, found_s = -1.0;  // −1: never
    std::uint32_t track = 0;
  };
  struct Life {
    double born_s;
    std::size_t scans = 0, false_scans = 0;
  };
  void end_stay(Stay& stay, double t_s);
  void judge_tracks(double t_s, const TrackList& tracks, const std::vector<Object>& objects);
  void judge_object(double t_s, const Object& object, const TrackList& tracks);

  Figures figures_;
  std::map<std::uint32_t, Stay> stays_;  // by object
  std::map<std::uint32_t, Life> lives_;  // by track
};

}  // namespace boresight::closed_loop
