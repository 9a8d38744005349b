// What stands beside the road: mirrors and scatterers, sorted by the road position they are found by.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/simulator/road.hpp"
#include "tests/simulator/scene.hpp"

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

/// Appends one structure, as far as it stands within `extent`. Its scatterers are drawn from the seed and `index`, each
/// from a stream of its own, so that they are the same whatever the extent.
void add_structure(const StructureSpec& spec, std::uint64_t index, const Road& road, Gap extent, std::uint64_t seed,
                   Roadside& roadside);

/// Appends the points of a scatter; of parked cars, which are bodies, none.
void add_scatter(const ScatterSpec& spec, std::uint64_t index, const Road& road, Gap extent, std::uint64_t seed,
                 Roadside& roadside);

/// A car that stands in one of a scatter's places.
struct ParkedCar {
  BodySpec spec;
  std::uint32_t place;  ///< its number, which depends on nothing but where it is
};

/// The parked cars of a scatter.
[[nodiscard]] std::vector<ParkedCar> parked_cars(const ScatterSpec& spec, std::uint64_t index, Gap extent,
                                                 std::uint64_t seed);

/// How many points, mirrors and cars at most the seed may draw of it within `extent`.
[[nodiscard]] double most_parts(const StructureSpec& spec, Gap extent);
[[nodiscard]] double most_parts(const ScatterSpec& spec, Gap extent);

}  // namespace boresight::simulator
