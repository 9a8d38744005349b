// The options of `boresight simulate` that give the vehicle the effects of a real car.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/simulator/car/real_car.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace boresight {

struct RealCarOptions {
  bool preset = false;
  std::vector<std::string> effects;  ///< KEY=VALUE, keys of [radars.real_car]
};

void add_real_car_options(CLI::App& command, RealCarOptions& options);

/// The effects that the options name; none if there is no such option. Throws config::Error for an unknown key or a
/// value out of range.
[[nodiscard]] std::optional<simulator::car::RealCar> real_car(const RealCarOptions& options);

}  // namespace boresight
