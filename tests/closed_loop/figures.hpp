// What the tracks of a simulated drive are worth, by the truth.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "tests/closed_loop/chain.hpp"
#include "tests/closed_loop/objects.hpp"
#include "tests/simulator/judge/hidden.hpp"
#include "tests/simulator/judge/matching.hpp"

namespace boresight::closed_loop {

/// Of the vehicle's centre from the ego vehicle: what four corner radars shall see.
constexpr double kFarthest_m = 60.0;
using judge::kHidden_s;
using judge::kMaxTrackDistance_m;
/// The alignment estimator, which here remembers nothing, takes over a second to find that a radar is 2.5° crooked;
/// what such a radar makes up meanwhile is counted apart.
constexpr double kAligned_s = 1.5;

struct Figures {
  std::size_t scans = 0;
  /// Stays of over 3 s within reach, from the first detection on until the object leaves or is hidden; and how long the
  /// longest was before it had a confirmed track.
  std::size_t stays = 0, stays_found = 0;
  double worst_delay_s = 0.0;
  std::size_t chances = 0, found = 0;  ///< scans of stays after 1.5 s, and with a confirmed track
  std::size_t switches = 0;            ///< of the track's id during a stay
  std::size_t twice = 0;               ///< further confirmed tracks at an object, each scan
  std::size_t ids = 0;
  /// Confirmed tracks of which most is at no object, and those of them that began before kAligned_s; and their scans.
  std::size_t false_ids = 0, early_false_ids = 0, false_scans = 0, early_false_scans = 0;
  /// Of the track nearest to an object.
  double along_rms_m = 0.0, across_rms_m = 0.0, velocity_rms_mps = 0.0, heading_rms_rad = 0.0;
  double length_bias_m = 0.0, width_bias_m = 0.0;

  [[nodiscard]] double share() const { return static_cast<double>(found) / static_cast<double>(chances); }
  [[nodiscard]] double false_tracks() const { return static_cast<double>(false_scans) / static_cast<double>(scans); }
  [[nodiscard]] double twice_tracks() const { return static_cast<double>(twice) / static_cast<double>(scans); }
};

/// Collects the figures of one drive.
class Judge {
 public:
  /// After each scan.
  void add(double t_s, const Chain& chain, const std::vector<simulator::DetectionTruth>& truth,
           const std::vector<Object>& objects);
  [[nodiscard]] Figures finish(double t_s);

 private:
  struct Stay {
    double since_s = -1.0, seen_s = -1.0, found_s = -1.0;  // −1: not
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
