#include "services/ingest_gateway/live_links.hpp"

#include <set>
#include <string>
#include <tuple>

#include "services/ingest_gateway/links/can_link.hpp"
#include "services/ingest_gateway/links/udp_link.hpp"

namespace boresight::ingest {

std::vector<std::unique_ptr<Link>> make_live_links(const VehicleConfig& vehicle, const LinkEvents& events) {
  std::vector<SourceAddress> sources{vehicle.ego.source};
  for (const RadarConfig& radar : vehicle.radars) sources.push_back(radar.source);
  std::set<std::string> can;
  std::set<std::tuple<std::string, std::uint16_t, std::string>> udp;
  std::vector<std::unique_ptr<Link>> links;
  for (const SourceAddress& source : sources) {
    if (source.link == LinkKind::kCan) {
      if (can.insert(source.interface).second) links.push_back(std::make_unique<CanLink>(source.interface, events));
    } else if (udp.emplace(source.address, source.port, source.interface).second) {
      links.push_back(std::make_unique<UdpLink>(source.address, source.port, source.interface, events));
    }
  }
  return links;
}

}  // namespace boresight::ingest
