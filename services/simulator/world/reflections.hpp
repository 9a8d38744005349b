// Reflections of a body: its reflection centres, with the micro-Doppler of rims and limbs, and its sides as mirrors.
#pragma once

#include <cstdint>
#include <vector>

#include "services/simulator/scene.hpp"
#include "services/simulator/world/motion.hpp"

namespace boresight::simulator {

struct Dimensions {
  double length_m, width_m, height_m, clearance_m;
  double side_low_m = 0.0;  ///< lower edge of the sides that mirror
};
[[nodiscard]] Dimensions dimensions_of(BodyKind kind);

/// Phase of the rotating rims or swinging limbs of a body at the beginning of the drive, 0 … 1.
using GaitPhase = double;

/// Appends the centres of `body` and sets its first_centre and number_of_centres. `travelled_m` gives the angle of rims
/// and limbs; `speed_mps` is along the heading.
void add_centres(Body& body, double travelled_m, double speed_mps, GaitPhase phase,
                 std::vector<ReflectionCentre>& centres);

/// Appends the four sides of a body that is large enough to mirror (van, truck); nothing for other kinds.
void add_sides(const Body& body, double loss_db, std::vector<MirrorSurface>& surfaces);

}  // namespace boresight::simulator
