// Domain and interfaces of the diagnostics. The topics are in topics.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/health/dds/security_config.hpp"

namespace boresight::dds {

struct Config {
  bool enabled = true;
  std::uint32_t domain = 0;
  /// Names or IPv4 addresses of network interfaces, or "all". By default no other machine can listen or interfere.
  std::vector<std::string> interfaces = {"127.0.0.1"};
  double period_s = 1.0;
  bool tracks = true;             ///< whether track lists are sent
  double tracks_period_s = 0.05;  ///< one track list in this time; 0: every list
  double farewell_s = 0.2;        ///< longest time that the end of the service waits for readers to learn of it
  /// File with the secret of those who may command; "": nobody may.
  std::string command_key_file;
  SecurityConfig security = {};
};

}  // namespace boresight::dds
