// config/services/ingest_gateway.toml → ingest::Config.
#pragma once

#include <cstdint>
#include <string>

#include "services/common/runtime/config/reader.hpp"
#include "services/ingest_gateway/core/contradiction_config.hpp"

namespace boresight::ingest {

enum class Input : std::uint8_t { kLive, kReplay };

struct Config {
  Input input = Input::kLive;
  std::string tunnel_path;  ///< path of the replay tunnel's socket
  ContradictionConfig contradiction;
};

/// $BORESIGHT_RUNTIME_DIR, else $RUNTIME_DIRECTORY (set by systemd), else /tmp/boresight-<uid>; plus "replay.sock".
[[nodiscard]] std::string default_tunnel_path();

/// Reads the document; the environment variable BORESIGHT_INPUT (live, replay) overrides `input`. Throws
/// config::Error.
[[nodiscard]] Config read_config(config::Reader root);

}  // namespace boresight::ingest
