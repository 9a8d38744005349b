// A scenario as plain data. Places are given along the road: `…_m` from its origin, where the ego vehicle starts by
// default, and `lateral_m` to the left of the road's line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/simulator/radar_effects.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator {

/// A value at a place or an instant. Between knots the value changes smoothly; before the first and after the last knot
/// it is constant.
struct Knot {
  double at = 0.0;
  double value = 0.0;
  [[nodiscard]] bool operator==(const Knot&) const = default;
};
using Knots = std::vector<Knot>;

// ---------------------------------------------------------------- road

struct RoadSegment {
  double length_m = 0.0;
  double curvature_per_m = 0.0;  ///< positive: to the left
  [[nodiscard]] bool operator==(const RoadSegment&) const = default;
};

/// Adds amplitude · sin(arc / length): a winding road.
struct RoadWave {
  double curvature_per_m = 0.0;
  double length_m = 1.0;
  [[nodiscard]] bool operator==(const RoadWave&) const = default;
};

/// Segments from the origin on. The road is straight before the first segment; the last segment has no end. The
/// curvature changes linearly (a clothoid) over `transition_m` about each border, over less where a segment is shorter.
struct RoadSpec {
  std::vector<RoadSegment> segments;
  double transition_m = 40.0;
  std::vector<RoadWave> waves;
  [[nodiscard]] bool operator==(const RoadSpec&) const = default;
};

// ---------------------------------------------------------------- ego vehicle

/// The ego vehicle follows the road at a lateral offset. Its box is what hides targets from its own radars.
struct EgoSpec {
  double start_m = 0.0;
  Knots speed_mps{{0.0, 15.0}};  ///< along the road, by time; negative: backwards
  double swing_mps = 0.0;        ///< amplitude added to the speed: swing · sin(2π t / period)
  double swing_period_s = 37.0;
  Knots lateral_m{{0.0, 0.0}};  ///< by road position
  double length_m = 4.7;
  double width_m = 1.9;
  double height_m = 1.5;
  double rear_overhang_m = 1.0;  ///< rear axle to rear end
  [[nodiscard]] bool operator==(const EgoSpec&) const = default;
};

// ---------------------------------------------------------------- structures

enum class StructureKind : std::uint8_t { kGuardRail, kWall, kNoiseBarrier, kTunnel, kFacade, kPillars };

struct Gap {
  double from_m = 0.0, to_m = 0.0;
  [[nodiscard]] bool operator==(const Gap&) const = default;
};

/// A structure that mirrors. It runs along the road from `from_m` to `to_m`. With `heading_rad` ≠ 0 it runs straight
/// instead: from (from_m, lateral_m) over to_m − from_m metres, in that direction relative to the road there.
struct StructureSpec {
  StructureKind kind = StructureKind::kGuardRail;
  double from_m = 0.0, to_m = 0.0;
  double lateral_m = 0.0;
  double heading_rad = 0.0;
  double width_m = 0.0;  ///< tunnel: from the left wall, at lateral_m, to the right wall; pillars: length of a side
  double low_m = 0.4, high_m = 0.8;  ///< edges of the mirror; a tunnel's ceiling is at high_m
  double loss_db = 5.5;              ///< of power, per bounce
  bool opaque = true;
  double spacing_m = 2.0;     ///< between scatterers: posts, facets, pillars
  double roughness_m = 0.05;  ///< standard deviation of the scatterers across the surface
  double rcs_min_dbsm = -8.0, rcs_max_dbsm = 2.0;
  std::vector<Gap> gaps;     ///< road positions; with a heading, metres from the structure's beginning
  double gap_every_m = 0.0;  ///< distance between regular gaps; 0: none
  double gap_length_m = 0.0;
  [[nodiscard]] bool operator==(const StructureSpec&) const = default;
};

// ---------------------------------------------------------------- scatter

enum class ScatterKind : std::uint8_t { kColumns, kVegetation, kKerb, kParkedCars };

/// Stationary scatter beside the road. Columns (poles, trees): points above each other. Vegetation: points anywhere
/// between the road and `top_max_m`. Kerb: low points in a line. Parked cars: bodies along the road.
struct ScatterSpec {
  ScatterKind kind = ScatterKind::kColumns;
  double from_m = 0.0, to_m = 0.0;
  double lateral_min_m = 0.0, lateral_max_m = 0.0;
  bool both_sides = true;  ///< the lateral offset is drawn with either sign; false: as given
  double per_m = 0.2;      ///< mean number per metre of road
  double top_min_m = 1.0, top_max_m = 9.0;
  double spacing_m = 1.7;  ///< vertical, between a column's points
  double rcs_min_dbsm = -5.0, rcs_max_dbsm = 10.0;
  double heading_rad = 0.0;  ///< of parked cars on the left side, relative to the road; mirrored on the right one
  [[nodiscard]] bool operator==(const ScatterSpec&) const = default;
};

// ---------------------------------------------------------------- bodies

/// A body that follows the road. With `heading_rad` ≠ 0 it crosses the road straight instead: from
/// (start_m, lateral_m.front()), in that direction relative to the road there. A size of 0 is that of the kind.
struct BodySpec {
  BodyKind kind = BodyKind::kCar;
  double start_m = 0.0;
  Knots lateral_m{{0.0, 0.0}};  ///< by road position
  Knots speed_mps{{0.0, 0.0}};  ///< along the road, by time; negative: oncoming
  double swing_mps = 0.0;       ///< as the ego vehicle's
  double swing_period_s = 37.0;
  double heading_rad = 0.0;
  bool parked = false;
  double length_m = 0.0, width_m = 0.0, height_m = 0.0;
  double side_low_m = 0.0;  ///< lower edge of the sides that mirror
  [[nodiscard]] bool operator==(const BodySpec&) const = default;
};

// ----------------------------------------------------------------

struct Scenario {
  std::string name;
  std::string about;
  std::string vehicle;       ///< name of the vehicle file it is meant for; may be empty
  double duration_s = 45.0;  ///< default length of the drive
  RoadSpec road;
  EgoSpec ego;
  std::vector<StructureSpec> structures;
  std::vector<ScatterSpec> scatter;
  std::vector<BodySpec> bodies;
  RadarEffects effects;
  [[nodiscard]] bool operator==(const Scenario&) const = default;
};

}  // namespace boresight::simulator
