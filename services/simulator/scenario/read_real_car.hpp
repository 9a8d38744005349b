// The effects of a real car as a table of TOML.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/simulator/car/real_car.hpp"

namespace boresight::simulator {

/// Reads the keys of config/schema/scenario.md, radars.real_car. `preset` sets all effects, other keys override it.
[[nodiscard]] car::RealCar read_real_car(config::Reader reader);

}  // namespace boresight::simulator
