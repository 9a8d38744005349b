// Corrected scans of a road between rails, ready in memory, for measuring cost: however long they are run, what is
// measured is the ghost filter and not the simulator.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/ghost_filter/core/method.hpp"

namespace boresight::bench {

/// The condition: of four radars with 300 detections each, the map accumulates 5,000 points.
inline constexpr double kMapPoints = 5000.0;

/// What a larger load sees: the same road within 100 m more closely, or as much more of the road, and beside it.
enum class Surroundings : std::uint8_t { kSame, kLarger };

class GhostLoad {
 public:
  /// `radars` × `detections` a cycle of 50 ms at 25 m/s. 87 % are of a standing world that is met again in every scan,
  /// so that the map holds about kMapPoints points in the same surroundings, and in larger ones × radars × detections /
  /// 1200: rails, a wall, parked cars, poles, and vegetation for the rest. Of the others (13 %) half are of tracked
  /// vehicles and half their mirror images in the rails; a longer road has as many more vehicles.
  GhostLoad(std::size_t radars, std::size_t detections, Surroundings surroundings);

  /// One scan of each radar and the tracks. Time goes on from call to call. `each`(radar) is called after each scan.
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
  /// Two seconds, until the map is full.
  void warm_up(ghosts::Method& method);
  [[nodiscard]] std::size_t scans_in_cycle() const { return radars_; }

 private:
  static constexpr std::size_t kCycles = 80;  // 100 m of road, then over again
  void build_world();
  void fill(CorrectedScan& scan, std::size_t cycle, std::size_t radar) const;
  const CorrectedScan& next_scan(std::size_t radar);
  std::size_t radars_, detections_;
  double reach_m_, half_width_m_;
  std::vector<Eigen::Vector2d> world_;                 // what stands on 100 m of road, which repeats
  std::vector<Eigen::Vector2d> vehicles_;              // relative to the own, all with its speed
  std::vector<std::unique_ptr<CorrectedScan>> scans_;  // by cycle, then radar
  TrackList tracks_{};
  std::unique_ptr<ClassifiedScan> out_ = std::make_unique<ClassifiedScan>();
  std::uint64_t cycle_ = 0;
};

/// Of one scan, with the tracks that are handed over after it; CPU time of the thread in µs, but where "wall" is said.
struct GhostCost {
  double mean_us, p99_us, max_us, wall_mean_us;
  double map_points;     ///< mean
  double mean_cycle_us;  ///< of one scan of each radar
  std::uint64_t allocations;
};
[[nodiscard]] GhostCost measure_ghost_cycles(GhostLoad& load, ghosts::Method& method, std::size_t cycles);

}  // namespace boresight::bench
