// config/services/replay.toml → replay::Config.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "services/common/runtime/config/reader.hpp"

namespace boresight::replay {

/// Keys of [someip], for --via someip.
struct SomeIpConfig {
  std::string discovery_group;  ///< "": the service definition's default for the IP version
  std::uint16_t discovery_port = 30490;
  std::uint16_t first_port = 30600;  ///< instance n sends its events from first_port + n
  int multicast_hops = 1;
  std::uint32_t data_id_base = 0x4253'0000;  ///< Data ID = base + instance << 8 + low byte of the event
};

/// Keys of [max_speed], for --speed max.
struct MaxSpeedConfig {
  std::size_t max_scans_in_flight = 1;  ///< scans that wait for their track list before the next frame is sent
  double timeout_s = 2.0;               ///< time without any track list after which the replay no longer waits
};

struct Config {
  std::string tunnel_path;                    ///< "": the default of the runtime directory
  std::map<std::string, std::string> routes;  ///< recorded IPv4 address → local address
  MaxSpeedConfig max_speed;
  SomeIpConfig someip;
};

/// Reads the document; throws config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::replay
