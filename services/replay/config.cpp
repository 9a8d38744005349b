#include "services/replay/config.hpp"

#include <fmt/format.h>

#include "interfaces/catalogue/catalogue.hpp"
#include "services/common/recording/ip_address.hpp"
#include "services/common/runtime/config/network_values.hpp"

namespace boresight::replay {

namespace {

/// The text of an address under `key`; notes an error if the key is given and no IP address.
std::string read_address(config::Reader& reader, std::string_view key) {
  std::string text = reader.text(key, "");
  if (reader.has(key) && !recording::parse_ip(text)) {
    reader.reject(key, fmt::format("\"{}\" is neither an IPv4 nor an IPv6 address", text));
  }
  return text;
}

void read_route(config::Reader& route, std::map<std::string, std::string>& routes) {
  route.require("recorded");
  route.require("local");
  const std::string recorded = read_address(route, "recorded");
  if (!routes.emplace(recorded, read_address(route, "local")).second) {
    route.reject("recorded", fmt::format("\"{}\" must have one route only", recorded));
  }
}

}  // namespace

Config read_config(config::Reader root) {
  Config c;
  c.tunnel_path = root.text("tunnel_path", "");
  if (const auto problem = config::problem_of_socket_path(c.tunnel_path)) root.reject("tunnel_path", *problem);
  for (config::Reader& route : root.tables("route")) read_route(route, c.routes);
  config::Reader max_speed = root.table("max_speed");
  // The gateway may publish the scan of one more frame. The queues of all readers still hold it.
  constexpr auto kMost =
      static_cast<double>(catalogue::queue_capacity(catalogue::topic(catalogue::TopicId::kRadarScan)));
  c.max_speed.max_scans_in_flight = static_cast<std::size_t>(max_speed.integer(
      "max_scans_in_flight", {1, kMost / 2}, static_cast<std::int64_t>(c.max_speed.max_scans_in_flight)));
  c.max_speed.timeout_s = max_speed.number("timeout_s", {0.1, 3600.0}, c.max_speed.timeout_s);
  config::Reader someip = root.table("someip");
  SomeIpConfig& s = c.someip;
  s.discovery_group = someip.text("discovery_group", "");
  if (!s.discovery_group.empty() && !recording::ip_or_unspecified(s.discovery_group).is_multicast()) {
    someip.reject("discovery_group", fmt::format("\"{}\" must be a multicast group, or \"\"", s.discovery_group));
  }
  s.discovery_port = static_cast<std::uint16_t>(someip.integer("discovery_port", {1, 65535}, s.discovery_port));
  s.first_port = static_cast<std::uint16_t>(someip.integer("first_port", {1024, 65519}, s.first_port));
  s.multicast_hops = static_cast<int>(someip.integer("multicast_hops", {0, 255}, s.multicast_hops));
  s.data_id_base = static_cast<std::uint32_t>(someip.integer("data_id_base", {0, 4294901760.0}, s.data_id_base));
  root.finish();
  return c;
}

}  // namespace boresight::replay
