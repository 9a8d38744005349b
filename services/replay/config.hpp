// config/services/replay.toml → replay::Config.
#pragma once

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

struct Config {
  std::string tunnel_path;                    ///< "": the default of the runtime directory
  std::map<std::string, std::string> routes;  ///< recorded IPv4 address → local address
  SomeIpConfig someip;
};

/// Reads the document; throws config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::replay
