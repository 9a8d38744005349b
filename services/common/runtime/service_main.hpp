// The main function of every service: parses the command line, checks the configuration, connects to RouDi, runs.
#pragma once

#include <functional>

#include "services/common/runtime/node.hpp"
#include "services/common/runtime/options.hpp"

namespace boresight::runtime {

/// Runs the service on a connected node until a signal stops it; returns the exit code of node.spin().
using Run = std::function<int(Node&)>;
/// Reads the configuration (throws config::Error) and returns what to run with it.
using Load = std::function<Run(const Configuration&)>;

/// What --check looks at in addition: findings with which the service runs nevertheless. Throws config::Error.
using Inspect = std::function<void(const Configuration&)>;

/// Handles --config DIR, --vehicle NAME|FILE, --check, --version, --help and SIGTERM. If the environment has
/// BORESIGHT_STOP_LIMIT_MS, the service ends that long after SIGTERM at the latest, by SIGKILL. Returns an exit code of
/// exit_codes.hpp.
int service_main(catalogue::Service self, int argc, char** argv, const Load& load, const Inspect& inspect = {});

}  // namespace boresight::runtime
