// What is true of one simulated detection.
#pragma once

#include <cstdint>

#include "interfaces/messages/classified_scan.hpp"
#include "tests/simulator/scene.hpp"

namespace boresight::simulator {

struct DetectionTruth {
  Provenance provenance = Provenance::kUnknown;
  std::uint32_t object_id =
      0;                     ///< Body::id that was seen, also of its ghosts; 0 for structures, scatterers and clutter
  Origin origin{};           ///< of structures and scatterers
  std::uint8_t bounces = 0;  ///< on mirrors; 0: direct
  std::uint32_t mirror_body = 0;  ///< Body::id whose side mirrored; 0: a structure, or none
};

}  // namespace boresight::simulator
