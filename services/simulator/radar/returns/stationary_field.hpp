// The dense, near, weak, flickering stationary world: patches of weak reflectors fixed to the world, of which a radar
// sees a few at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/radar/antenna.hpp"
#include "services/simulator/radar/profile.hpp"
#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/viewpoint.hpp"

namespace boresight::simulator::radar {

struct FieldPoint {
  Eigen::Vector3d position_m;
  double strength;  ///< standard normal, lasts as long as the point
  std::uint64_t key;
};

class StationaryField {
 public:
  explicit StationaryField(const StationaryWorldSpec& spec);

  /// Replaces `points` by the points that are bright for this radar in this cycle, without regard to occlusion.
  /// Patches lie in layers. A layer reaches one ring farther than the layer before, so far rings show fewer points. A
  /// patch is bright with probability `bright_share`; what it shows is held from scan to scan with probability
  /// `seen_again`.
  void look(const Viewpoint& view, const Antenna& antenna, const EgoPose& ego, const Draws& draws,
            std::vector<FieldPoint>& points) const;

  /// Patches of a layer per m²; layer k reaches (k + 1)·kRing_m.
  [[nodiscard]] double density_per_m2(std::size_t layer) const { return density_per_m2_[layer]; }

 private:
  void show(const Eigen::Vector2d& patch_m, std::uint64_t key, Stream& stream, std::vector<FieldPoint>& points) const;
  StationaryWorldSpec spec_;
  std::array<double, kRings> density_per_m2_{};
};

}  // namespace boresight::simulator::radar
