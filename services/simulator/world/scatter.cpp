#include <algorithm>
#include <cmath>

#include "services/simulator/random.hpp"
#include "services/simulator/world/reflections.hpp"
#include "services/simulator/world/structures.hpp"

namespace boresight::simulator {

namespace {

constexpr double kCell_m = 2.0;  // length of a road cell; each cell has a random stream of its own
constexpr double kLowest_m = 0.4;
constexpr double kKerb_m = 0.1;

/// Visits the cells of the scatter within `extent`, each with its random stream and its number.
template <typename Visit>
void for_cells(const ScatterSpec& spec, std::uint64_t index, Gap extent, std::uint64_t seed, double cell_m,
               const Visit& visit) {
  const double first = std::max(0.0, std::ceil((extent.from_m - spec.from_m) / cell_m));
  const double to_m = std::min(spec.to_m, extent.to_m);
  for (auto cell = static_cast<std::uint64_t>(first);; ++cell) {
    const double at = spec.from_m + static_cast<double>(cell) * cell_m;
    if (at + cell_m > to_m) return;
    Stream draw(seed, "scatter", index, cell);
    visit(at, draw, cell);
  }
}

double lateral(const ScatterSpec& spec, Stream& draw) {
  const double side = spec.both_sides && draw.uniform() < 0.5 ? -1.0 : 1.0;
  return side * draw.uniform(spec.lateral_min_m, spec.lateral_max_m);
}

}  // namespace

void add_scatter(const ScatterSpec& spec, std::uint64_t index, const Road& road, Gap extent, std::uint64_t seed,
                 Roadside& roadside) {
  if (spec.kind == ScatterKind::kParkedCars) return;
  const Origin origin{Origin::Kind::kScatter, static_cast<std::uint32_t>(index)};
  const auto add = [&](double arc, double lateral_m, double height_m, Stream& draw) {
    const Eigen::Vector2d p = road.place(arc, lateral_m);
    roadside.scatterers.push_back(
        {arc, {{p.x(), p.y(), height_m}, draw.uniform(spec.rcs_min_dbsm, spec.rcs_max_dbsm), origin}});
  };
  for_cells(spec, index, extent, seed, kCell_m, [&](double at, Stream& draw, std::uint64_t) {
    const unsigned count = draw.poisson(spec.per_m * kCell_m);
    for (unsigned i = 0; i < count; ++i) {
      const double lateral_m = lateral(spec, draw);
      const double arc = at + draw.uniform(0.0, kCell_m);
      const double top_m = draw.uniform(spec.top_min_m, spec.top_max_m);
      switch (spec.kind) {
        case ScatterKind::kColumns:
          // Horizontal spread of a tree's branches or a pole's arms.
          for (double z = kLowest_m; z < top_m; z += spec.spacing_m) {
            add(arc + 0.3 * draw.gaussian(), lateral_m + 0.3 * draw.gaussian(), z, draw);
          }
          break;
        case ScatterKind::kVegetation:
          add(arc, lateral_m, draw.uniform(0.0, top_m), draw);
          break;
        case ScatterKind::kKerb:
          add(arc, lateral_m, kKerb_m, draw);
          break;
        case ScatterKind::kParkedCars:
          break;
      }
    }
  });
}

std::vector<ParkedCar> parked_cars(const ScatterSpec& spec, std::uint64_t index, Gap extent, std::uint64_t seed) {
  std::vector<ParkedCar> cars;
  if (spec.kind != ScatterKind::kParkedCars) return cars;
  // Each car has a parking place of its own; `per_m` sets the share of places that are taken.
  const Dimensions size = dimensions_of(BodyKind::kCar);
  const bool crosswise = spec.heading_rad != 0.0;
  const double place_m = crosswise ? size.width_m + 0.7 : size.length_m + 1.2;
  for_cells(spec, index, extent, seed, place_m, [&](double at, Stream& draw, std::uint64_t cell) {
    for (const double side : {1.0, -1.0}) {
      const bool taken = draw.uniform() < spec.per_m * place_m;
      const double lateral_m = side * draw.uniform(spec.lateral_min_m, spec.lateral_max_m);
      const double jitter_m = draw.uniform(-0.3, 0.3);
      const bool van = draw.uniform() < 0.12;
      if (!taken || (side < 0.0 && !spec.both_sides)) continue;
      BodySpec car;
      car.kind = van ? BodyKind::kVan : BodyKind::kCar;
      car.start_m = at + 0.5 * place_m + jitter_m * (crosswise ? 0.5 : 1.0);
      car.lateral_m = {{0.0, lateral_m}};
      car.heading_rad = side * spec.heading_rad;
      car.parked = true;
      cars.push_back({car, static_cast<std::uint32_t>(2 * cell + (side > 0.0 ? 0 : 1))});
    }
  });
  return cars;
}

double most_parts(const ScatterSpec& spec, Gap extent) {
  const double length_m = std::max(0.0, std::min(spec.to_m, extent.to_m) - std::max(spec.from_m, extent.from_m));
  const bool columns = spec.kind == ScatterKind::kColumns;
  const double each = columns ? 1.0 + std::max(0.0, spec.top_max_m - kLowest_m) / spec.spacing_m : 1.0;
  const double sides = spec.kind == ScatterKind::kParkedCars && spec.both_sides ? 2.0 : 1.0;
  return length_m * spec.per_m * each * sides;
}

}  // namespace boresight::simulator
