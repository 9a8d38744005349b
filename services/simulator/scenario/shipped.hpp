// The files of config/scenarios/, compiled into the program.
#pragma once

#include <span>
#include <string_view>

namespace boresight::simulator {

struct ShippedScenario {
  std::string_view name;  ///< of the file without ".toml"
  std::string_view text;
};
/// Sorted by name. Generated, see services/simulator/CMakeLists.txt.
[[nodiscard]] std::span<const ShippedScenario> shipped_scenarios();

}  // namespace boresight::simulator
