// What to record of a vehicle: which CAN interfaces, and which datagrams of which network interfaces.
#pragma once

#include <string>
#include <vector>

#include "services/common/recording/ip_address.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::record {

struct PacketSource {
  std::string interface;                        ///< "any": all of them
  std::string filter;                           ///< of libpcap; empty: everything
  std::vector<recording::IpAddress> multicast;  ///< groups to join, as switches forward them to members only
};

struct CapturePlan {
  std::vector<std::string> can;
  std::vector<PacketSource> packets;
};

/// The datagrams that the vehicle's radars and ego signals arrive in, every fragment of them, tagged for a VLAN or not,
/// and SOME/IP service discovery beside them.
[[nodiscard]] CapturePlan plan_of(const VehicleConfig& vehicle);

}  // namespace boresight::record
