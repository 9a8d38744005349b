// DDS Security of a participant: checks its files, and makes the middleware use them. A participant that cannot be
// protected is not created.
#pragma once

#include <cstdint>
#include <string>

#include "services/health/dds/security_config.hpp"

namespace eprosima::fastdds::dds {
class DomainParticipantQos;
}  // namespace eprosima::fastdds::dds

namespace boresight::dds {

struct SecurityState {
  /// Why the files cannot be used, as "dds.security.<key>: <file>: <reason>"; empty if they can be.
  std::string problem;
  /// The first end of a validity, in seconds since the epoch. Later no new participant accepts this one.
  std::int64_t valid_until_s = INT64_MAX;
};

/// Checks all files as the middleware uses them, for a DDS domain and a time in seconds since the epoch. In addition,
/// refuses documents that leave the domain open. Without enabled security there is nothing to check.
[[nodiscard]] SecurityState check_security(const SecurityConfig& config, std::uint32_t domain, std::int64_t now_s);

/// Enables security in `qos` if `config` does. Throws std::runtime_error if check_security() finds a problem now.
void secure(eprosima::fastdds::dds::DomainParticipantQos& qos, const SecurityConfig& config, std::uint32_t domain);

}  // namespace boresight::dds
