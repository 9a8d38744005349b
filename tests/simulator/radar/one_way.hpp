// One-way paths between the sensor and a target, by the image method: direct, over the ground, by one mirror, by two.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/simulator/radar/mirror.hpp"
#include "tests/simulator/radar/occlusion.hpp"
#include "tests/simulator/radar/target.hpp"
#include "tests/simulator/radar/viewpoint.hpp"
#include "tests/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

struct OneWay {
  Eigen::Vector3d direction;  ///< unit, world: where the path leaves the sensor
  Eigen::Vector3d incidence;  ///< unit, world: where it comes from, seen from the target
  double length_m;
  double rate_mps;  ///< exact time derivative of the length
  double loss_db;   ///< besides the spreading; negative where the ground adds
  std::uint8_t mirrors;
  std::uint32_t mirror_body;  ///< whose side the sensor sees it in; 0: a structure, or none
  std::uint64_t key;          ///< of the mirrors in their order
};

class Propagation {
 public:
  Propagation(const MultipathSpec& multipath, double range_max_m) : spec_(multipath), range_max_m_(range_max_m) {}

  /// Takes over what mirrors and what hides. Buffers are reused.
  void prepare(const Scene& scene, const Viewpoint& view, const EgoBox& ego);

  /// Appends the direct path (or, hidden, that over the ground below what hides it). `embedded_m`: see Occlusion.
  void direct(const Target& target, double embedded_m, std::vector<OneWay>& paths) const;

  /// Chooses the mirrors, and pairs of them, in which something within `radius_m` of `centre_m` may be seen; `mirrored`
  /// looks at these only.
  void choose(const Eigen::Vector3d& centre_m, double radius_m);

  /// Appends paths by way of one mirror and of two. A body's own sides show no image of itself.
  void mirrored(const Target& target, std::vector<OneWay>& paths) const;

 private:
  /// The sensor itself (mirror −1), or its image in a mirror.
  struct Source {
    Eigen::Vector3d position;
    int mirror;
  };
  struct Pair {
    std::uint32_t source, mirror;
  };
  void add_mirrors(const Scene& scene);
  void add_pairs();
  [[nodiscard]] bool sees(const Source& source, const Mirror& mirror) const;

  MultipathSpec spec_;
  double range_max_m_;
  Viewpoint view_{};
  Occlusion occlusion_;
  std::vector<Mirror> mirrors_;
  std::vector<Source> sources_;
  std::vector<Pair> pairs_, chosen_;
};

}  // namespace boresight::simulator::radar
