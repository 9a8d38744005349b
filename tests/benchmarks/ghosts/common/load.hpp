// Corrected scans of a road between guard rails, prepared in memory, for measuring cost: only the ghost filter runs
// while time is taken, not the simulator.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/ghost_filter/core/method.hpp"

namespace boresight::bench {

class GhostLoad {
 public:
  /// `radars` × `detections` per cycle of 50 ms at 25 m/s. 80 % are stationary: guard rails, a wall, parked cars, poles
  /// and vegetation, detected again in every scan, with reflectors among them. 10 % are direct echoes of kVehicles
  /// vehicles, each with a confirmed track. 10 % are false moving detections: in turn a mirror image of a vehicle in a
  /// rail, and a detection at any place with any range rate.
  GhostLoad(std::size_t radars, std::size_t detections);

  static constexpr std::size_t kVehicles = 30;

  /// One scan of each radar and the tracks. Time advances with each call. `each`(radar) is called after each scan.
  template <typename Each>
  void give_cycle(ghosts::Method& method, const Each& each) {
    for (std::size_t radar = 0; radar < radars_; ++radar) {
      const CorrectedScan& scan = next_scan(radar);
      method.classify(scan, *out_);
      method.add_tracks(tracks_);
      each(radar);
    }
    ++cycle_;
  }
  /// Two seconds of driving; then the map is full.
  void warm_up(ghosts::Method& method);
  [[nodiscard]] std::size_t scans_in_cycle() const { return radars_; }

 private:
  static constexpr std::size_t kCycles = 80;  // 100 m of road, then repeated
  void build_world();
  void build_tracks();
  void fill(CorrectedScan& scan, std::size_t cycle, std::size_t radar) const;
  const CorrectedScan& next_scan(std::size_t radar);
  std::size_t radars_, detections_;
  std::vector<Eigen::Vector2d> world_;                 // stationary reflection points of 100 m of road, which repeats
  std::vector<Eigen::Vector2d> vehicles_;              // relative to the ego vehicle, all with its speed
  std::vector<std::unique_ptr<CorrectedScan>> scans_;  // by cycle, then radar
  TrackList tracks_{};
  std::unique_ptr<ClassifiedScan> out_ = std::make_unique<ClassifiedScan>();
  std::uint64_t cycle_ = 0;
};

/// Cost of one scan, including the tracks handed over after it: CPU time of the thread.
struct GhostCost {
  double mean_us = 0.0, p99_us = 0.0, max_us = 0.0;
  double map_points = 0.0;  ///< mean
  std::uint64_t allocations = 0;
};
[[nodiscard]] GhostCost measure_ghost_cycles(GhostLoad& load, ghosts::Method& method, std::size_t cycles);

}  // namespace boresight::bench
