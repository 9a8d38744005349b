// The command line that every service has.
#pragma once

#include <filesystem>
#include <string>

#include "interfaces/catalogue/catalogue.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::runtime {

/// Where a process finds its configuration, and which vehicle it is for.
struct Configuration {
  std::filesystem::path directory;  ///< --config DIR: holds vehicle/ and services/
  std::string vehicle_name;         ///< --vehicle NAME, else $BORESIGHT_VEHICLE, else the only file in vehicle/

  /// DIR/services/<name>.toml.
  [[nodiscard]] std::filesystem::path service_file(std::string_view name) const;
  /// DIR/vehicle/<vehicle_name>.toml; throws config::Error if the name is empty and there is not exactly one file.
  [[nodiscard]] std::filesystem::path vehicle_file() const;
  /// Reads and checks the vehicle file; throws config::Error.
  [[nodiscard]] VehicleConfig vehicle() const;
};

}  // namespace boresight::runtime
