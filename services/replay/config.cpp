#include "services/replay/config.hpp"

namespace boresight::replay {

Config read_config(config::Reader root) {
  Config c;
  c.tunnel_path = root.text("tunnel_path", "");
  for (config::Reader& route : root.tables("route")) {
    route.require("recorded");
    route.require("local");
    c.routes[route.text("recorded", "")] = route.text("local", "");
  }
  config::Reader someip = root.table("someip");
  SomeIpConfig& s = c.someip;
  s.discovery_group = someip.text("discovery_group", "");
  s.discovery_port = static_cast<std::uint16_t>(someip.integer("discovery_port", {1, 65535}, s.discovery_port));
  s.first_port = static_cast<std::uint16_t>(someip.integer("first_port", {1024, 65519}, s.first_port));
  s.multicast_hops = static_cast<int>(someip.integer("multicast_hops", {0, 255}, s.multicast_hops));
  s.data_id_base = static_cast<std::uint32_t>(someip.integer("data_id_base", {0, 4294901760.0}, s.data_id_base));
  root.finish();
  return c;
}

}  // namespace boresight::replay
