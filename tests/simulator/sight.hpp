// What a radar could see of each body at an instant, whether or not it detected it.
#pragma once

#include <cstdint>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "tests/simulator/radar/antenna.hpp"
#include "tests/simulator/radar/ego_body.hpp"
#include "tests/simulator/radar/occlusion.hpp"
#include "tests/simulator/radar_effects.hpp"
#include "tests/simulator/scene.hpp"

namespace boresight::simulator {

/// Reflection centres of a body, counted.
struct BodySight {
  std::uint32_t body_id;
  std::uint32_t centres;  ///< that it has
  std::uint32_t in_view;  ///< of these within the field of view and its range
  std::uint32_t seen;     ///< of these turned towards the radar with nothing in between
};

/// The lines of sight of one radar as it is really mounted at the time. Mirrors and the ground play no part.
class Sight {
 public:
  Sight(const RadarConfig& config, const RadarEffects& effects, const radar::EgoBody& ego_body);

  /// Replaces `bodies` by those of the scene that are at least partly in view. Buffers are reused.
  void look(const Scene& scene, std::vector<BodySight>& bodies);

 private:
  RadarConfig config_;
  RadarEffects effects_;
  radar::EgoBox ego_box_;
  radar::Antenna antenna_;
  radar::Occlusion occlusion_;
};

}  // namespace boresight::simulator
