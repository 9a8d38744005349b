#include "services/simulator/scenario/reading.hpp"

namespace boresight::simulator {

namespace {

using config::Range;
using config::Reader;

constexpr Range kLateral_m{-200.0, 200.0};
constexpr Range kHeight_m{0.0, 50.0};
constexpr Range kSpacing_m{0.05, 100.0};
constexpr Range kRcs_dbsm{-60.0, 60.0};

/// Defaults of a kind, for keys that the file does not set. The values are choices, not measurements.
StructureSpec usual(StructureKind kind) {
  StructureSpec s;
  s.kind = kind;
  switch (kind) {
    case StructureKind::kGuardRail:
      break;
    case StructureKind::kWall:
      s.low_m = 0.0, s.high_m = 2.5, s.loss_db = 6.0, s.spacing_m = 1.0;
      break;
    case StructureKind::kNoiseBarrier:
      s.low_m = 0.0, s.high_m = 4.0, s.loss_db = 5.0, s.spacing_m = 2.0;
      break;
    case StructureKind::kTunnel:
      s.low_m = 0.0, s.high_m = 5.0, s.loss_db = 5.0, s.spacing_m = 1.5, s.width_m = 11.0;
      break;
    case StructureKind::kFacade:
      s.low_m = 0.0, s.high_m = 12.0, s.loss_db = 5.0, s.spacing_m = 1.0, s.roughness_m = 0.2;
      break;
    case StructureKind::kPillars:
      s.low_m = 0.0, s.high_m = 2.6, s.loss_db = 6.0, s.spacing_m = 7.5, s.width_m = 0.6;
      break;
  }
  return s;
}

ScatterSpec usual(ScatterKind kind) {
  ScatterSpec s;
  s.kind = kind;
  switch (kind) {
    case ScatterKind::kColumns:
      break;
    case ScatterKind::kVegetation:
      s.top_min_m = 0.3, s.top_max_m = 2.0, s.rcs_min_dbsm = -20.0, s.rcs_max_dbsm = -5.0;
      break;
    case ScatterKind::kKerb:
      s.top_min_m = 0.0, s.top_max_m = 0.1, s.rcs_min_dbsm = -22.0, s.rcs_max_dbsm = -12.0;
      break;
    case ScatterKind::kParkedCars:
      s.per_m = 0.1;
      break;
  }
  return s;
}

void read_rcs(Reader& reader, double& min_dbsm, double& max_dbsm) {
  min_dbsm = reader.number("rcs_min_dbsm", kRcs_dbsm, min_dbsm);
  max_dbsm = reader.number("rcs_max_dbsm", kRcs_dbsm, max_dbsm);
  if (max_dbsm < min_dbsm) reader.reject("rcs_max_dbsm", "must not be less than rcs_min_dbsm");
}

/// Reads the two ends of a stretch of road, in this order.
void read_extent(Reader& reader, double& from_m, double& to_m) {
  reader.require("from_m");
  reader.require("to_m");
  from_m = reader.number("from_m", kRoad_m, 0.0);
  to_m = reader.number("to_m", kRoad_m, 1.0);
  if (to_m <= from_m) reader.reject("to_m", "must be greater than from_m");
}

}  // namespace

StructureSpec read_structure(Reader reader) {
  reader.require("kind");
  reader.require("lateral_m");
  StructureSpec s = usual(reader.choice<StructureKind>("kind",
                                                       {{"guard_rail", StructureKind::kGuardRail},
                                                        {"wall", StructureKind::kWall},
                                                        {"noise_barrier", StructureKind::kNoiseBarrier},
                                                        {"tunnel", StructureKind::kTunnel},
                                                        {"facade", StructureKind::kFacade},
                                                        {"pillars", StructureKind::kPillars}},
                                                       StructureKind::kGuardRail));
  read_extent(reader, s.from_m, s.to_m);
  s.lateral_m = reader.number("lateral_m", kLateral_m, 0.0);
  s.heading_rad = reader.angle_deg("heading_deg", {-180.0, 180.0}, 0.0);
  if (s.heading_rad != 0.0 && s.to_m - s.from_m > 100.0) {
    reader.reject("heading_deg", "a structure that leads off the road is at most 100 m long");
  }
  s.width_m = reader.number("width_m", {0.0, 100.0}, s.width_m);
  s.low_m = reader.number("low_m", kHeight_m, s.low_m);
  s.high_m = reader.number("high_m", kHeight_m, s.high_m);
  if (s.high_m <= s.low_m) reader.reject("high_m", "must be greater than low_m");
  s.loss_db = reader.number("loss_db", {0.0, 60.0}, s.loss_db);
  s.opaque = reader.boolean("opaque", s.opaque);
  s.spacing_m = reader.number("spacing_m", kSpacing_m, s.spacing_m);
  s.roughness_m = reader.number("roughness_m", {0.0, 5.0}, s.roughness_m);
  read_rcs(reader, s.rcs_min_dbsm, s.rcs_max_dbsm);
  for (Reader& r : reader.tables("gaps")) {
    Gap gap;
    read_extent(r, gap.from_m, gap.to_m);
    s.gaps.push_back(gap);
  }
  s.gap_every_m = reader.number("gap_every_m", {0.0, 1e4}, s.gap_every_m);
  s.gap_length_m = reader.number("gap_length_m", {0.0, 1e4}, s.gap_length_m);
  if (s.gap_every_m > 0.0 && s.gap_every_m < 1.0) reader.reject("gap_every_m", "must be 0 or at least 1");
  return s;
}

ScatterSpec read_scatter(Reader reader) {
  reader.require("kind");
  ScatterSpec s = usual(reader.choice<ScatterKind>("kind",
                                                   {{"columns", ScatterKind::kColumns},
                                                    {"vegetation", ScatterKind::kVegetation},
                                                    {"kerb", ScatterKind::kKerb},
                                                    {"parked_cars", ScatterKind::kParkedCars}},
                                                   ScatterKind::kColumns));
  read_extent(reader, s.from_m, s.to_m);
  reader.require("lateral_min_m");
  reader.require("lateral_max_m");
  s.lateral_min_m = reader.number("lateral_min_m", kLateral_m, 0.0);
  s.lateral_max_m = reader.number("lateral_max_m", kLateral_m, s.lateral_min_m);
  if (s.lateral_max_m < s.lateral_min_m) reader.reject("lateral_max_m", "must not be less than lateral_min_m");
  s.both_sides = reader.boolean("both_sides", s.both_sides);
  s.per_m = reader.number("per_m", {0.0, 20.0}, s.per_m);
  s.top_min_m = reader.number("top_min_m", kHeight_m, s.top_min_m);
  s.top_max_m = reader.number("top_max_m", kHeight_m, s.top_max_m);
  if (s.top_max_m < s.top_min_m) reader.reject("top_max_m", "must not be less than top_min_m");
  s.spacing_m = reader.number("spacing_m", kSpacing_m, s.spacing_m);
  read_rcs(reader, s.rcs_min_dbsm, s.rcs_max_dbsm);
  s.heading_rad = reader.angle_deg("heading_deg", {-180.0, 180.0}, s.heading_rad);
  return s;
}

}  // namespace boresight::simulator
