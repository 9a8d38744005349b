// Domain and interfaces of the diagnostics. The topics are in topics.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace boresight::dds {

struct Config {
  bool enabled = true;
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces;  ///< IPv4 addresses; empty: all
  double period_s = 1.0;
  bool tracks = true;             ///< whether track lists are sent
  double tracks_period_s = 0.05;  ///< one track list in this time; 0: every list
  /// File with the secret of those who may command; "": nobody may.
  std::string command_key_file;
};

}  // namespace boresight::dds
