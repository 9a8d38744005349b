// Stationary structures beside the road: mirrors and scatterers, with the road position for the search.
#pragma once

#include <cstdint>
#include <vector>

#include "services/simulator/road.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator {

struct PlacedSurface {
  double arc_m;  ///< of its middle
  MirrorSurface surface;
};
struct PlacedScatterer {
  double arc_m;
  Scatterer scatterer;
};

struct Roadside {
  std::vector<PlacedSurface> surfaces;
  std::vector<PlacedScatterer> scatterers;
};

/// Appends the part of one structure that lies within `extent`. Each scatterer has a random stream of its own, made
/// from the seed, `index` and its number. So it does not depend on the extent.
void add_structure(const StructureSpec& spec, std::uint64_t index, const Road& road, Gap extent, std::uint64_t seed,
                   Roadside& roadside);

/// Appends the points of a scatter; none for parked cars, which are bodies.
void add_scatter(const ScatterSpec& spec, std::uint64_t index, const Road& road, Gap extent, std::uint64_t seed,
                 Roadside& roadside);

/// A parked car of a scatter.
struct ParkedCar {
  BodySpec spec;
  std::uint32_t place;  ///< number of its parking place, which depends on the position only
};

/// The parked cars of a scatter.
[[nodiscard]] std::vector<ParkedCar> parked_cars(const ScatterSpec& spec, std::uint64_t index, Gap extent,
                                                 std::uint64_t seed);

/// Estimated number of points, mirrors and cars within `extent`.
[[nodiscard]] double most_parts(const StructureSpec& spec, Gap extent);
[[nodiscard]] double most_parts(const ScatterSpec& spec, Gap extent);

}  // namespace boresight::simulator
