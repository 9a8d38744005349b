#include "services/common/runtime/options.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "services/common/runtime/config/vehicle_file.hpp"

namespace boresight::runtime {

std::filesystem::path Configuration::service_file(std::string_view name) const {
  return directory / "services" / fmt::format("{}.toml", name);
}

std::filesystem::path Configuration::vehicle_file() const {
  const std::filesystem::path folder = directory / "vehicle";
  if (!vehicle_name.empty()) return folder / (vehicle_name + ".toml");
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  if (error) throw config::Error(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
  if (names.empty()) throw config::Error(fmt::format("{}: holds no vehicle (*.toml)", folder.string()));
  if (names.size() > 1) {
    std::sort(names.begin(), names.end());
    throw config::Error(fmt::format("{}: holds several vehicles; name one by --vehicle or $BORESIGHT_VEHICLE: {}",
                                    folder.string(), fmt::join(names, ", ")));
  }
  return folder / (names.front() + ".toml");
}

VehicleConfig Configuration::vehicle() const {
  return config::read_vehicle_file(vehicle_file());
}

}  // namespace boresight::runtime
