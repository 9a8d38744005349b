// The options of --via someip.
#pragma once

#include <string>

#include "services/common/vehicle/vehicle.hpp"
#include "services/replay/config.hpp"
#include "services/replay/player.hpp"
#include "services/replay/server/synthetic_play.hpp"

namespace CLI {
class App;
}

namespace boresight::replay {

/// Values of the options.
struct SomeIpCommand {
  std::string interface;
  std::string address;
  std::string group;
  double offer_cycle_s = 1.0;
  double share_ms = 0.0;
  SyntheticOptions synthetic;
};

void add_someip_options(CLI::App& app, SomeIpCommand& command);

/// Serves recordings, or synthetic scans, until their end or a stop signal; prints the numbers of sent events.
/// `vehicle` is required for recordings; it is optional for synthetic radars and gives their mountings. Waits `wait_s`
/// for the first subscriber of recordings. Throws config::Error for a wrong command line and std::runtime_error for the
/// network.
void serve_someip(const SomeIpCommand& command, const SomeIpConfig& config, const VehicleConfig* vehicle,
                  const PlayOptions& play, double wait_s);

}  // namespace boresight::replay
