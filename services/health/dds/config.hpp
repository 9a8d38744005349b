// Domain, interfaces and topics of the diagnostics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/health/dds/security_config.hpp"

namespace boresight::dds {

struct Config {
  bool enabled = true;
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces;  ///< IPv4 addresses; empty: all
  double period_s = 1.0;
  /// File with the secret of those who may command; "": nobody may.
  std::string command_key_file;
  SecurityConfig security = {};
};

inline constexpr const char* kSensorHealthTopic = "boresight/sensor_health";
inline constexpr const char* kSystemHealthTopic = "boresight/system_health";
inline constexpr const char* kDiagnosticsTopic = "rt/diagnostics";
inline constexpr const char* kFaultRecordTopic = "boresight/fault_memory";
inline constexpr const char* kFaultMemoryStateTopic = "boresight/fault_memory_state";
inline constexpr const char* kCommandTopic = "boresight/fault_memory_command";
inline constexpr const char* kCommandReplyTopic = "boresight/fault_memory_reply";

}  // namespace boresight::dds
