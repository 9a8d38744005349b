#include "services/boresight/commands/real_car_options.hpp"

#include <CLI/CLI.hpp>

#include "services/common/runtime/config/reader.hpp"
#include "services/simulator/scenario/read_real_car.hpp"

namespace boresight {

void add_real_car_options(CLI::App& command, RealCarOptions& options) {
  command.add_flag("--real-car", options.preset,
                   "All effects of a real car, instead of those of the scenario: the preset real_car");
  command
      .add_option("--real-car-effect", options.effects,
                  "An effect of a real car, as in [radars.real_car] of a scenario, such as range_rate_scale=0.0025; "
                  "repeatable; with --real-car it changes the preset")
      ->type_name("KEY=VALUE")
      ->delimiter(',');
}

std::optional<simulator::car::RealCar> real_car(const RealCarOptions& options) {
  if (!options.preset && options.effects.empty()) return std::nullopt;
  std::string text = options.preset ? "preset = \"real_car\"\n" : "";
  for (const std::string& effect : options.effects) text += effect + "\n";
  config::Reader reader = config::Reader::parse(text, "--real-car-effect");
  const simulator::car::RealCar car = simulator::read_real_car(reader);
  reader.finish();
  return car;
}

}  // namespace boresight
