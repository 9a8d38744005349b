#include "services/alignment_estimator/station/settings.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/runtime/config/network_values.hpp"

namespace boresight::alignment::station {

namespace {

void read_network(config::Reader& table, Settings& s) {
  namespace discovery = wire::boresight_service::discovery;
  s.interface = table.text("interface", s.interface);
  const std::string address = table.text("address", "");
  s.address = recording::ip_or_unspecified(address);
  s.port = static_cast<std::uint16_t>(table.integer("port", {1024, 65535}, s.port));
  s.instance = static_cast<std::uint16_t>(table.integer("instance", {1, 65534}, s.instance));
  std::string group = table.text("discovery_group", "");
  if (group.empty()) group = s.address.is_v4() ? discovery::kMulticastIpv4 : discovery::kMulticastIpv6;
  s.discovery_group.address = recording::ip_or_unspecified(group);
  s.discovery_group.port = static_cast<std::uint16_t>(table.integer("discovery_port", {1, 65535}, discovery::kPort));
  s.multicast_hops = static_cast<int>(table.integer("multicast_hops", {0, 255}, s.multicast_hops));
  for (const auto& [key, text] : {std::pair("address", address), std::pair("discovery_group", group)}) {
    if (!text.empty() && !recording::parse_ip(text)) {
      table.reject(key, fmt::format("\"{}\" is neither an IPv4 nor an IPv6 address", text));
    }
  }
  if (!s.interface.empty() && !config::is_interface_name(s.interface)) {
    table.reject("interface", "must be a network interface's name of 1 … 15 characters without blanks, '/' and ':'");
  }
  if (!s.enabled) return;
  if (s.interface.empty())
    table.reject("interface", "is empty; must be a network interface's name with enabled = true");
  if (s.address.is_unspecified() || s.address.is_multicast()) {
    table.reject("address",
                 "\"" + address + "\" is no address of one host; must be a unicast IP address of this machine");
  } else if (!s.discovery_group.address.is_multicast() || s.discovery_group.address.is_v4() != s.address.is_v4()) {
    table.reject("discovery_group", "\"" + group + "\" is not a multicast group of the same IP version as address");
  }
  if (s.port == s.discovery_group.port) table.reject("port", "is the port of service discovery");
}

}  // namespace

Settings read_settings(config::Reader table) {
  Settings s;
  s.enabled = table.boolean("enabled", s.enabled);
  read_network(table, s);
  s.max_speed_mps = table.number("max_speed_mps", {0.0, 1.0}, s.max_speed_mps);

  plate::PlateWindow& window = s.plate.window;
  window.range_min_m = table.number("range_min_m", {0.1, 20.0}, window.range_min_m);
  window.range_max_m = table.number("range_max_m", {0.2, 50.0}, window.range_max_m);
  if (window.range_min_m >= window.range_max_m) table.reject("range_max_m", "must be greater than range_min_m");
  window.azimuth_half_width_rad = table.angle_deg("azimuth_half_width_deg", {0.5, 45.0}, window.azimuth_half_width_rad);
  window.max_range_rate_mps = table.number("max_range_rate_mps", {0.01, 5.0}, window.max_range_rate_mps);
  window.amplitude = table.choice<plate::Amplitude>(
      "amplitude", {{"any", plate::Amplitude::kAny}, {"rcs", plate::Amplitude::kRcs}, {"snr", plate::Amplitude::kSnr}},
      window.amplitude);

  plate::FitConfig& fit = s.plate.fit;
  fit.method = table.choice<plate::FitMethod>(
      "method", {{"robust", plate::FitMethod::kRobust}, {"published", plate::FitMethod::kPublished}}, fit.method);
  fit.min_tilts = static_cast<std::size_t>(
      table.integer("min_tilts", {static_cast<double>(plate::kFewestTilts), static_cast<double>(plate::kMaxTilts)},
                    static_cast<std::int64_t>(fit.min_tilts)));
  fit.min_amplitude_db = table.number("min_amplitude_db", {-200.0, 200.0}, fit.min_amplitude_db);

  const config::Range timeout_s{0.1, 3600.0};
  s.plate.positioning_timeout_s = table.number("positioning_timeout_s", timeout_s, s.plate.positioning_timeout_s);
  s.plate.measuring_timeout_s = table.number("measuring_timeout_s", timeout_s, s.plate.measuring_timeout_s);
  s.plate.silence_timeout_s = table.number("silence_timeout_s", timeout_s, s.plate.silence_timeout_s);
  s.plate.decision_timeout_s = table.number("decision_timeout_s", timeout_s, s.plate.decision_timeout_s);
  s.plate.settle_s = table.number("settle_s", {0.0, 10.0}, s.plate.settle_s);
  s.plate.tilt_tolerance_rad = table.angle_deg("tilt_tolerance_deg", {0.01, 5.0}, s.plate.tilt_tolerance_rad);

  s.seed.placement_yaw_std_rad = table.angle_deg("placement_yaw_std_deg", {0.0, 5.0}, s.seed.placement_yaw_std_rad);
  s.seed.placement_pitch_std_rad =
      table.angle_deg("placement_pitch_std_deg", {0.0, 5.0}, s.seed.placement_pitch_std_rad);
  return s;
}

}  // namespace boresight::alignment::station
