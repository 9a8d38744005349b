// Truth of one simulated detection.
#pragma once

#include <cstdint>

#include "interfaces/messages/classified_scan.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator {

struct DetectionTruth {
  Provenance provenance = Provenance::kUnknown;
  std::uint32_t object_id =
      0;                     ///< Body::id of the target, also for its ghosts; 0 for structures, scatterers and clutter
  Origin origin{};           ///< for structures and scatterers
  std::uint8_t bounces = 0;  ///< reflections from mirrors; 0: direct
  std::uint32_t mirror_body = 0;  ///< Body::id whose side mirrored; 0: a structure, or none
};

}  // namespace boresight::simulator
