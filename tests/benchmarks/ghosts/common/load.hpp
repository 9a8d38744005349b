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

/// Map size of the cost bar: four radars with 300 detections each accumulate about this many points.
inline constexpr double kMapPoints = 5000.0;

/// Surroundings of a larger load: the same 100 m of road sampled more densely, or a proportionally larger area.
enum class Surroundings : std::uint8_t { kSame, kLarger };

class GhostLoad {
 public:
  /// `radars` × `detections` per cycle of 50 ms at 25 m/s. 87 % are stationary: guard rails, a wall, parked cars, poles
  /// and vegetation, detected again in every scan. The map then holds about kMapPoints points in the same surroundings,
  /// and × radars × detections / 1200 in larger ones. The other 13 % are moving: half of them tracked vehicles, half
  /// their mirror images in the rails. A longer road has proportionally more vehicles.
  GhostLoad(std::size_t radars, std::size_t detections, Surroundings surroundings);

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
  void fill(CorrectedScan& scan, std::size_t cycle, std::size_t radar) const;
  const CorrectedScan& next_scan(std::size_t radar);
  std::size_t radars_, detections_;
  double reach_m_, half_width_m_;
  std::vector<Eigen::Vector2d> world_;                 // stationary reflection points of 100 m of road, which repeats
  std::vector<Eigen::Vector2d> vehicles_;              // relative to the ego vehicle, all with its speed
  std::vector<std::unique_ptr<CorrectedScan>> scans_;  // by cycle, then radar
  TrackList tracks_{};
  std::unique_ptr<ClassifiedScan> out_ = std::make_unique<ClassifiedScan>();
  std::uint64_t cycle_ = 0;
};

/// Cost of one scan, including the tracks handed over after it. CPU time of the thread in µs, except the "wall" time.
struct GhostCost {
  double mean_us, p99_us, max_us, wall_mean_us;
  double map_points;     ///< mean
  double mean_cycle_us;  ///< one scan of each radar
  std::uint64_t allocations;
};
[[nodiscard]] GhostCost measure_ghost_cycles(GhostLoad& load, ghosts::Method& method, std::size_t cycles);

}  // namespace boresight::bench
