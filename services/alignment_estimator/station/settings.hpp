// Table [station] of config/services/alignment_estimator.toml → settings of the calibration service.
#pragma once

#include <cstdint>
#include <string>

#include "interfaces/wire/calibration_service.hpp"
#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/alignment_estimator/core/plate/station.hpp"
#include "services/common/recording/ip_address.hpp"
#include "services/common/runtime/config/reader.hpp"

namespace boresight::alignment::station {

struct Settings {
  bool enabled = false;
  std::string interface;
  recording::IpAddress address;                                  ///< of this machine on that interface
  std::uint16_t port = wire::calibration_service::kDefaultPort;  ///< for requests
  std::uint16_t instance = wire::calibration_service::kDefaultInstance;
  recording::Endpoint discovery_group;
  int multicast_hops = 1;
  double max_speed_mps = 0.1;  ///< signalled speed up to which the vehicle counts as stationary
  plate::StationConfig plate;
  SeedConfig seed;
};

/// Adds errors to the reader. Interface and address are required only if the service is enabled.
[[nodiscard]] Settings read_settings(config::Reader table);

}  // namespace boresight::alignment::station
