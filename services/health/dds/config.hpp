// Domain, interfaces and topics of the diagnostics.
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
};

inline constexpr const char* kSensorHealthTopic = "boresight/sensor_health";
inline constexpr const char* kDiagnosticsTopic = "rt/diagnostics";

}  // namespace boresight::dds
