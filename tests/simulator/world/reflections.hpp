// What of a body reflects: its reflection centres, moving as wheels and limbs do, and its sides as mirrors.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/simulator/scene.hpp"
#include "tests/simulator/world/motion.hpp"

namespace boresight::simulator {

struct Dimensions {
  double length_m, width_m, height_m, clearance_m;
  double flank_low_m = 0.0;  ///< of what mirrors
};
[[nodiscard]] Dimensions dimensions_of(BodyKind kind);

/// Where a body's wheels and limbs are in their cycle at the drive's begin, 0 … 1.
using GaitPhase = double;

/// Appends the centres of `body`, whose first_centre and number_of_centres it sets. `travelled_m` turns its wheels and
/// swings its limbs; `speed_mps` is along its heading.
void add_centres(Body& body, double travelled_m, double speed_mps, GaitPhase phase,
                 std::vector<ReflectionCentre>& centres);

/// Appends the four sides of a body large enough to mirror (van, truck); of the others none.
void add_sides(const Body& body, double loss_db, std::vector<MirrorSurface>& surfaces);

}  // namespace boresight::simulator
