// The inputs to record of a vehicle: CAN interfaces, and datagrams of network interfaces.
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

/// All fragments of the datagrams of the vehicle's radars and ego signals, with VLAN tag or without, and SOME/IP
/// service discovery.
[[nodiscard]] CapturePlan plan_of(const VehicleConfig& vehicle);

}  // namespace boresight::record
