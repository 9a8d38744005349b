// One-way propagation paths between the sensor and a target by the method of mirror images: direct, over the ground, by
// one mirror, by two mirrors.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/radar/mirror.hpp"
#include "services/simulator/radar/occlusion.hpp"
#include "services/simulator/radar/target.hpp"
#include "services/simulator/radar/viewpoint.hpp"
#include "services/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

struct OneWay {
  Eigen::Vector3d direction;  ///< unit vector, world: in which the path leaves the sensor
  Eigen::Vector3d incidence;  ///< unit vector, world: from the target back along the path
  double length_m;
  double rate_mps;  ///< exact time derivative of the length
  double loss_db;   ///< in addition to the spreading; negative where the ground ray adds power
  std::uint8_t mirrors;
  std::uint32_t mirror_body;  ///< body whose side is the mirror nearest to the sensor; 0: a structure, or none
  std::uint64_t key;          ///< of the mirrors in their order
};

class Propagation {
 public:
  Propagation(const MultipathSpec& multipath, double range_max_m) : spec_(multipath), range_max_m_(range_max_m) {}

  /// Takes the mirrors and obstacles of the scene. Buffers are reused.
  void prepare(const Scene& scene, const Viewpoint& view, const EgoBox& ego);

  /// Appends the direct path. If it is blocked and the path over the ground is free, appends that one. `embedded_m`:
  /// see Occlusion.
  void direct(const Target& target, double embedded_m, std::vector<OneWay>& paths) const;

  /// Whether the direct line from the sensor to a stationary point is free.
  [[nodiscard]] bool clear(const Eigen::Vector3d& point_m) const { return occlusion_.clear(view_.position_m, point_m); }

  /// Chooses the mirrors, and pairs of mirrors, that may reflect a target within `radius_m` of `centre_m`. `mirrored`
  /// uses only these.
  void choose(const Eigen::Vector3d& centre_m, double radius_m);

  /// Appends the paths by one mirror and by two mirrors. A body is not mirrored by its own sides.
  void mirrored(const Target& target, std::vector<OneWay>& paths) const;

 private:
  /// The sensor itself (mirror −1), or its mirror image.
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
