// config/services/replay.toml → replay::Config.
#pragma once

#include <map>
#include <string>

#include "services/common/runtime/config/reader.hpp"

namespace boresight::replay {

struct Config {
  std::string tunnel_path;                    ///< "": the default of the runtime directory
  std::map<std::string, std::string> routes;  ///< recorded IPv4 address → local one
};

/// Reads the document; throws config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::replay
