// The probabilities of a detection's origins that follow from the published message. The ghost filter publishes one
// probability (of a ghost or clutter) and a label; what lies between is divided evenly, so that nothing is invented.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/corrected_scan.hpp"

namespace boresight::run {

/// Moving, stationary, ghost of type 1, ghost of type 2, clutter; their sum is 1.
using OriginProbabilities = std::array<float, 5>;

/// None if the detection is not classified. Of g = `ghost_probability`, the rest 1 − g belongs to moving or stationary:
/// to the label if it is one of them, else to what the corrector's test of the range rate found, else half to each. g
/// belongs to the label if that is a ghost or clutter, else a third to each of these three.
[[nodiscard]] inline std::optional<OriginProbabilities> probabilities_of(Provenance label, float ghost_probability,
                                                                         std::uint16_t corrected_flags) {
  if (label == Provenance::kUnknown || !(ghost_probability >= 0.0F && ghost_probability <= 1.0F)) return std::nullopt;
  OriginProbabilities p{};
  const float direct = 1.0F - ghost_probability;
  const bool is_direct = label == Provenance::kMoving || label == Provenance::kStationary;
  const bool moves = is_direct ? label == Provenance::kMoving : (corrected_flags & corrected_flag::kMoving) != 0;
  const bool stands = is_direct ? !moves : (corrected_flags & corrected_flag::kStationary) != 0;
  p[0] = moves ? direct : stands ? 0.0F : 0.5F * direct;
  p[1] = stands ? direct : moves ? 0.0F : 0.5F * direct;
  constexpr std::size_t kFirstGhost = 2;
  constexpr float kGhostOrigins = 3.0F;
  for (std::size_t i = kFirstGhost; i < p.size(); ++i) {
    const auto origin = static_cast<Provenance>(i + 1);
    p[i] = is_direct ? ghost_probability / kGhostOrigins : origin == label ? ghost_probability : 0.0F;
  }
  return p;
}

}  // namespace boresight::run
