// The files of config/scenarios/ and config/radar_profiles/, compiled into the program.
#pragma once

#include <span>
#include <string_view>

namespace boresight::simulator {

struct ShippedFile {
  std::string_view name;  ///< of the file without ".toml"
  std::string_view text;
};
/// Both are sorted by name. Generated, see services/simulator/CMakeLists.txt.
[[nodiscard]] std::span<const ShippedFile> shipped_scenarios();
[[nodiscard]] std::span<const ShippedFile> shipped_radar_profiles();

}  // namespace boresight::simulator
