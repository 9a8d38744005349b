#include "services/boresight/record/capture_plan.hpp"

#include <algorithm>

namespace boresight::record {

namespace {

/// Only the first fragment has a port, so all later fragments to the same address are recorded.
std::string filter_of(const SourceAddress& source) {
  const auto address = recording::parse_ip(source.address);
  const std::string port = "udp dst port " + std::to_string(source.port);
  if (!address || address->is_unspecified()) return "(" + port + " or (ip[6:2] & 0x3fff != 0) or (ip6[6] == 44))";
  const std::string fragments = address->is_v4() ? "ip[6:2] & 0x1fff != 0" : "ip6[6] == 44";
  std::string filter = "(dst host " + source.address + " and (" + port + " or (" + fragments + "))";
  if (!source.sender.empty()) filter += " and src host " + source.sender;
  return filter + ")";
}

/// Service discovery determines where events are sent: to a port of this ECU, or to a multicast group of the server.
std::string someip_filter_of(const SourceAddress& source) {
  return "(udp and (dst host " + source.address + " or ip multicast or ip6 multicast))";
}

template <typename T>
void add_once(std::vector<T>& list, const T& value) {
  if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

struct Collected {
  std::string interface;
  std::vector<std::string> filters;
  std::vector<recording::IpAddress> multicast;
};

}  // namespace

CapturePlan plan_of(const VehicleConfig& vehicle) {
  std::vector<const SourceAddress*> sources{&vehicle.ego.source};
  for (const RadarConfig& radar : vehicle.radars) sources.push_back(&radar.source);

  CapturePlan plan;
  std::vector<Collected> networks;
  for (const SourceAddress* source : sources) {
    if (source->link == LinkKind::kCan) {
      if (!source->interface.empty()) add_once(plan.can, source->interface);
      continue;
    }
    const std::string interface = source->interface.empty() ? "any" : source->interface;
    auto network = std::find_if(networks.begin(), networks.end(),
                                [&](const Collected& candidate) { return candidate.interface == interface; });
    if (network == networks.end()) {
      networks.push_back({interface, {"udp port " + std::to_string(source->discovery_port)}, {}});
      network = networks.end() - 1;
    }
    const bool is_someip = source->link == LinkKind::kSomeIp;
    add_once(network->filters, is_someip ? someip_filter_of(*source) : filter_of(*source));
    const auto address = recording::parse_ip(is_someip ? source->discovery_address : source->address);
    if (address && address->is_multicast()) add_once(network->multicast, *address);
  }
  for (const Collected& network : networks) {
    std::string any_of;
    for (const std::string& filter : network.filters) any_of += (any_of.empty() ? "" : " or ") + filter;
    // `vlan` shifts the offsets of all later expressions by the tag.
    plan.packets.push_back({network.interface, "(" + any_of + ") or (vlan and (" + any_of + "))", network.multicast});
  }
  return plan;
}

}  // namespace boresight::record
