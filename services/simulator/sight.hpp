// Visibility of each body from a radar at an instant, independent of detection.
#pragma once

#include <cstdint>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/radar/antenna.hpp"
#include "services/simulator/radar/ego_body.hpp"
#include "services/simulator/radar/occlusion.hpp"
#include "services/simulator/radar_effects.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator {

/// Numbers of a body's reflection centres.
struct BodySight {
  std::uint32_t body_id;
  std::uint32_t centres;  ///< all of the body
  std::uint32_t in_view;  ///< those within the field of view and its range
  std::uint32_t seen;     ///< those in view that face the radar with a free line of sight
};

/// Lines of sight of one radar with its true mounting at the time; the configured position is the true one. Paths by
/// mirrors or the ground are not considered.
class Sight {
 public:
  Sight(const RadarConfig& config, const RadarEffects& effects, const radar::EgoBody& ego_body);

  /// Replaces `bodies` by the bodies of the scene that are at least partly in view. Buffers are reused.
  void look(const Scene& scene, std::vector<BodySight>& bodies);

 private:
  RadarConfig config_;
  RadarEffects effects_;
  radar::EgoBox ego_box_;
  radar::Antenna antenna_;
  radar::Occlusion occlusion_;
};

}  // namespace boresight::simulator
