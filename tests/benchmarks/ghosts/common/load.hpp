// Corrected scans of a road between rails, ready in memory, for measuring cost: however long they are run, what is
// measured is the ghost filter and not the simulator.
#pragma once

#include <memory>
#include <vector>

#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/ghost_filter/core/method.hpp"

namespace boresight::bench {

class GhostLoad {
 public:
  /// `radars` × `detections` a cycle of 50 ms: 85 % stationary (rails, and what stands beside them, over an area that
  /// grows with the number of radars), the rest moving: six tracked vehicles and their mirror images.
  GhostLoad(std::size_t radars, std::size_t detections);

  /// One scan of each radar and the tracks; returns the number of detections. Time goes on from call to call.
  std::size_t give_cycle(ghosts::Method& method);
  /// A second and a half, until the map is full.
  void warm_up(ghosts::Method& method);
  [[nodiscard]] std::size_t scans_in_cycle() const { return radars_; }

 private:
  static constexpr std::size_t kCycles = 40;  // then over again
  void fill(CorrectedScan& scan, std::size_t cycle, std::size_t radar) const;
  std::size_t radars_, detections_;
  std::vector<std::unique_ptr<CorrectedScan>> scans_;  // by cycle, then radar
  TrackList tracks_{};
  std::unique_ptr<ClassifiedScan> out_ = std::make_unique<ClassifiedScan>();
  std::uint64_t cycle_ = 0;
};

struct GhostCost {
  double us_per_scan, us_per_cycle;  ///< medians
  std::uint64_t allocations;
};
[[nodiscard]] GhostCost measure_ghost_cycles(GhostLoad& load, ghosts::Method& method, std::size_t cycles);

}  // namespace boresight::bench
