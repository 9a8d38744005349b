#include "services/boresight/commands/truth_file.hpp"

#include <stdexcept>
#include <string>

#include <toml++/toml.h>

namespace boresight {

report::Truth read_truth(const std::filesystem::path& file) {
  constexpr double kRadians = 3.14159265358979323846 / 180.0;
  report::Truth truth;
  try {
    const toml::table root = toml::parse_file(file.string());
    truth.speed_scale = root["speed_scale"].value<double>();
    if (const toml::array* const radars = root["radar"].as_array()) {
      for (const toml::node& node : *radars) {
        const toml::table* const radar = node.as_table();
        if (radar == nullptr) continue;
        const auto id = (*radar)["id"].value<std::int64_t>();
        const auto yaw_deg = (*radar)["yaw_deg"].value<double>();
        if (id && yaw_deg) truth.yaw_rad[static_cast<std::uint32_t>(*id)] = *yaw_deg * kRadians;
      }
    }
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(file.string() + ": " + std::string(error.description()));
  }
  if (!truth.known()) throw std::runtime_error(file.string() + ": no [[radar]] with id and yaw_deg");
  return truth;
}

}  // namespace boresight
