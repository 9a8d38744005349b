// What main() of every service does: parse the command line, check the configuration, connect, run.
#pragma once

#include <functional>

#include "services/common/runtime/node.hpp"
#include "services/common/runtime/options.hpp"

namespace boresight::runtime {

/// Runs the service on a connected node until it is told to stop; returns the exit code (node.spin()).
using Run = std::function<int(Node&)>;
/// Reads the configuration (throws config::Error) and returns what to run with it.
using Load = std::function<Run(const Configuration&)>;

/// Handles --config DIR, --vehicle NAME, --check, --version, --help and SIGTERM. Exit codes: 0 stopped as asked,
/// 2 wrong command line or configuration, 1 anything else.
int service_main(catalogue::Service self, int argc, char** argv, const Load& load);

}  // namespace boresight::runtime
