// Runs methods on a simulated drive through corrector, ghost filter and tracker, and judges them by the truth.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "interfaces/messages/names.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/judge/confusion.hpp"
#include "services/simulator/judge/false_tracks.hpp"
#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/ghosts/common/lost_objects.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/reliability.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::bench {

using judge::Confusion;
using judge::FalseTracks;
using judge::GhostTrack;

/// Type-1 ghosts farther than kApart_m from the box of their object. The others lie where a part of the object itself
/// could be: no test of positions can distinguish them.
struct ApartGhosts {
  static constexpr double kApart_m = 0.5;
  std::uint64_t all = 0, apart = 0,
                apart_classified_ghost = 0;  ///< not rejected; of these apart; of these classified as ghost
};

/// Result of one method on one drive, from its first scan on.
struct Outcome {
  Confusion confusion;
  ApartGhosts type1;
  Reliability reliability;  ///< of ghost_probability, for detections that the corrector classified as moving
  LostObjects lost;
  LostByChance lost_by_chance;  ///< on the same drive, the same for all methods
  std::uint64_t scans = 0;
  std::vector<GhostTrack> long_ghost_tracks;
  std::size_t longest_ghost_track_scans = 0;
  std::size_t long_other_tracks = 0;  ///< caused by clutter or stationary objects
};

/// One scan with the output of one method.
struct Observed {
  const simulator::Drive& drive;
  const simulator::Event& event;
  const std::vector<closed_loop::Object>& objects;  ///< at the scan's time
  const ClassifiedScan& scan;
  const TrackList& tracks;  ///< after the scan
  std::size_t method;       ///< index of the method
};
using Observer = std::function<void(const Observed&)>;

struct GhostDrive {
  std::string scenario;  ///< or its file
  std::string profile;   ///< of all radars, or its file; empty: as the scenario says
  std::uint64_t seed = 1;
  double duration_s = 20.0;  ///< at most as long as the scenario states
};

/// All methods on the same drive, each with a tracker of its own: one outcome per method. `observe` is called for each
/// scan and method, if given.
[[nodiscard]] std::vector<Outcome> run_ghost_drive(const GhostDrive& of, std::span<const NamedGhostMethod> methods,
                                                   const Observer& observe = {});

/// Seeds from options.first_seed on, spread over threads; by method, then seed.
[[nodiscard]] std::vector<std::vector<Outcome>> run_ghost_drives(const std::string& scenario,
                                                                 std::span<const NamedGhostMethod> methods,
                                                                 std::size_t seeds, double duration_s,
                                                                 const Options& options);

/// Duration of a drive; --quick shortens it.
[[nodiscard]] inline double drive_seconds(const Options& options, double wanted) {
  return options.quick ? std::min(wanted, 2.0) : wanted;
}

}  // namespace boresight::bench
