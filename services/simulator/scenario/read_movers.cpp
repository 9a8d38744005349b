#include <algorithm>
#include <cmath>

#include "services/simulator/scenario/reading.hpp"

namespace boresight::simulator {

namespace {

using config::Range;
using config::Reader;

constexpr Range kSpeed_mps{-80.0, 80.0};
constexpr Range kMoverLateral_m{-200.0, 200.0};

/// Reads either one value under `constant`, or a list of tables under `list`, each with `at` and `constant`.
Knots read_knots(Reader& reader, std::string_view constant, std::string_view list, std::string_view at, Range places,
                 Range values, Knots fallback) {
  // Both getters are called in any case, so that both keys are known.
  const double everywhere = reader.number(constant, values, fallback.front().value);
  std::vector<Reader> tables = reader.tables(list);
  if (!reader.has(list)) {
    if (!reader.has(constant)) return fallback;
    return {{0.0, everywhere}};
  }
  if (reader.has(constant)) reader.reject(constant, "cannot be given together with " + std::string(list));
  Knots knots;
  for (Reader& r : tables) {
    r.require(at);
    r.require(constant);
    knots.push_back({r.number(at, places, 0.0), r.number(constant, values, 0.0)});
    if (knots.size() > 1 && !(knots.back().at > knots[knots.size() - 2].at))
      r.reject(at, "must be greater than in the entry before");
  }
  if (knots.empty()) {
    reader.reject(list, "must not be empty");
    return fallback;
  }
  return knots;
}

Knots read_speed(Reader& reader, const Knots& fallback) {
  return read_knots(reader, "speed_mps", "speed", "t_s", {0.0, 36000.0}, kSpeed_mps, fallback);
}
Knots read_lateral(Reader& reader) {
  return read_knots(reader, "lateral_m", "lateral", "at_m", kRoad_m, kMoverLateral_m, {{0.0, 0.0}});
}

/// Reads the swing of an EgoSpec or a BodySpec. Its speed must have been read before.
template <typename Mover>
void read_swing(Reader& reader, Mover& mover) {
  mover.swing_mps = reader.number("swing_mps", {0.0, 40.0}, mover.swing_mps);
  mover.swing_period_s = reader.number("swing_period_s", {1.0, 1000.0}, mover.swing_period_s);
  const bool exceeds = std::any_of(mover.speed_mps.begin(), mover.speed_mps.end(),
                                   [&](const Knot& k) { return std::abs(k.value) < mover.swing_mps; });
  if (mover.swing_mps > 0.0 && exceeds) reader.reject("swing_mps", "must not exceed the speed");
}

}  // namespace

RoadSpec read_road(Reader reader) {
  RoadSpec road;
  constexpr Range kCurvature_per_m{-0.5, 0.5};
  road.transition_m = reader.number("transition_m", {0.1, 1000.0}, road.transition_m);
  for (Reader& r : reader.tables("segments")) {
    r.require("length_m");
    road.segments.push_back(
        {r.number("length_m", {0.1, 1e5}, 100.0), r.number("curvature_per_m", kCurvature_per_m, 0.0)});
  }
  for (Reader& r : reader.tables("waves")) {
    r.require("curvature_per_m");
    r.require("length_m");
    road.waves.push_back({r.number("curvature_per_m", kCurvature_per_m, 0.0), r.number("length_m", {1.0, 1e4}, 100.0)});
  }
  return road;
}

EgoSpec read_ego(Reader reader) {
  EgoSpec ego;
  ego.start_m = reader.number("start_m", kRoad_m, ego.start_m);
  ego.speed_mps = read_speed(reader, ego.speed_mps);
  read_swing(reader, ego);
  ego.lateral_m = read_lateral(reader);
  ego.length_m = reader.number("length_m", {0.5, 30.0}, ego.length_m);
  ego.width_m = reader.number("width_m", {0.3, 4.0}, ego.width_m);
  ego.height_m = reader.number("height_m", {0.3, 5.0}, ego.height_m);
  ego.rear_overhang_m = reader.number("rear_overhang_m", {0.0, 10.0}, ego.rear_overhang_m);
  return ego;
}

void read_body(Reader reader, std::vector<BodySpec>& bodies) {
  BodySpec body;
  reader.require("kind");
  reader.require("start_m");
  body.kind = reader.choice<BodyKind>("kind",
                                      {{"car", BodyKind::kCar},
                                       {"van", BodyKind::kVan},
                                       {"truck", BodyKind::kTruck},
                                       {"pedestrian", BodyKind::kPedestrian},
                                       {"cyclist", BodyKind::kCyclist}},
                                      body.kind);
  body.start_m = reader.number("start_m", kRoad_m, body.start_m);
  body.lateral_m = read_lateral(reader);
  body.speed_mps = read_speed(reader, body.speed_mps);
  read_swing(reader, body);
  body.heading_rad = reader.angle_deg("heading_deg", {-180.0, 180.0}, body.heading_rad);
  body.parked = reader.boolean("parked", body.parked);
  if (body.parked && (reader.has("speed_mps") || reader.has("speed"))) {
    reader.reject("parked", "a parked body has no speed");
  }
  body.length_m = reader.number("length_m", {0.1, 30.0}, body.length_m);
  body.width_m = reader.number("width_m", {0.1, 5.0}, body.width_m);
  body.height_m = reader.number("height_m", {0.1, 5.0}, body.height_m);
  body.side_low_m = reader.number("side_low_m", {0.05, 5.0}, body.side_low_m);
  Reader repeat = reader.table("repeat");
  const auto count = repeat.integer("count", {1, 1000}, 1);
  const double every_m = repeat.number("every_m", {-1e4, 1e4}, 0.0);
  if (count > 1 && every_m == 0.0) repeat.reject("every_m", "must not be 0");
  for (std::int64_t i = 0; i < count; ++i) {
    bodies.push_back(body);
    bodies.back().start_m += static_cast<double>(i) * every_m;
  }
}

}  // namespace boresight::simulator
