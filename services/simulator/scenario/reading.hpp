// Parts of a scenario file; see read_scenario.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/simulator/scenario.hpp"

namespace boresight::simulator {

[[nodiscard]] RoadSpec read_road(config::Reader reader);
[[nodiscard]] EgoSpec read_ego(config::Reader reader);
[[nodiscard]] StructureSpec read_structure(config::Reader reader);
[[nodiscard]] ScatterSpec read_scatter(config::Reader reader);
/// Reads one [[body]]; appends several bodies if it has `repeat`.
void read_body(config::Reader reader, std::vector<BodySpec>& bodies);
[[nodiscard]] RadarEffects read_effects(config::Reader reader);

/// Allowed positions along the road, in metres.
inline constexpr config::Range kRoad_m{-1e5, 1e5};

}  // namespace boresight::simulator
