// Methods on a simulated drive, through corrector, ghost filter and tracker, judged by the truth.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "interfaces/messages/names.hpp"
#include "tests/benchmarks/common/options.hpp"
#include "tests/benchmarks/ghosts/common/lost_objects.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/reliability.hpp"
#include "tests/closed_loop/objects.hpp"
#include "tests/simulator/drive.hpp"
#include "tests/simulator/judge/confusion.hpp"
#include "tests/simulator/judge/false_tracks.hpp"

namespace boresight::bench {

using judge::Confusion;
using judge::FalseTracks;
using judge::GhostTrack;
using judge::kTruths;

/// Type-1 ghosts farther than kApart_m from the box of their object. The others lie where a part of the object itself
/// could: no test of places can tell them.
struct ApartGhosts {
  static constexpr double kApart_m = 0.5;
  std::uint64_t all = 0, apart = 0, apart_told = 0;  ///< not left out; of these apart; of these told to be a ghost
};

/// What one method made of one drive, from its first scan on.
struct Outcome {
  Confusion confusion;
  ApartGhosts type1;
  Reliability reliability;  ///< of ghost_probability, of detections that the corrector found moving
  LostObjects lost;
  LostByChance lost_by_chance;  ///< on the same drive, whatever the method
  std::uint64_t scans = 0;
  std::vector<GhostTrack> long_ghost_tracks;
  std::size_t longest_ghost_track_scans = 0;
  std::size_t long_other_tracks = 0;  ///< of clutter or the stationary world
};

/// One scan with what a method made of it.
struct Observed {
  const simulator::Drive& drive;
  const simulator::Event& event;
  const std::vector<closed_loop::Object>& objects;  ///< at the scan's time
  const ClassifiedScan& scan;
  const TrackList& tracks;  ///< after the scan
  std::size_t method;       ///< which of those that were given
};
using Observer = std::function<void(const Observed&)>;

/// All methods on the same drive, each with a tracker of its own: one outcome a method. `name`: of a scenario or its
/// file; at most as long as that makes sense. `observe` is called for each scan and method, if given.
[[nodiscard]] std::vector<Outcome> run_ghost_drive(const std::string& name, std::span<const NamedGhostMethod> methods,
                                                   std::uint64_t seed, double duration_s, const Observer& observe = {});

/// Seeds from options.first_seed on, spread over threads; by method, then seed.
[[nodiscard]] std::vector<std::vector<Outcome>> run_ghost_drives(const std::string& scenario,
                                                                 std::span<const NamedGhostMethod> methods,
                                                                 std::size_t seeds, double duration_s,
                                                                 const Options& options);

/// Of a drive: --quick shows that it runs.
[[nodiscard]] inline double drive_seconds(const Options& options, double wanted) {
  return options.quick ? std::min(wanted, 2.0) : wanted;
}

}  // namespace boresight::bench
