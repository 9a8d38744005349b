#include "services/replay/server/command.hpp"

#include <charconv>
#include <cstdio>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/server/someip_sender.hpp"

namespace boresight::replay {

namespace service = wire::boresight_service;

namespace {

recording::IpAddress address_of(const std::string& text, const std::string& option) {
  const auto address = recording::parse_ip(text);
  if (!address || address->is_unspecified()) throw config::Error(option + ": \"" + text + "\" is not an IP address");
  return *address;
}

/// "239.66.83.1:30650" or "[ff14::1]:30650".
recording::Endpoint group_of(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  std::string address = text.substr(0, colon);
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (address.size() > 2 && address.front() == '[' && address.back() == ']') {
    address = address.substr(1, address.size() - 2);
  }
  recording::Endpoint group{address_of(address, "--group"), 0};
  const auto read = std::from_chars(port.data(), port.data() + port.size(), group.port);
  if (read.ec != std::errc{} || read.ptr != port.data() + port.size() || group.port == 0 ||
      !group.address.is_multicast()) {
    throw config::Error("--group: \"" + text + "\" is not a multicast group and port, as in 239.66.83.1:30650");
  }
  return group;
}

SomeIpOptions server_options(const SomeIpCommand& command, const SomeIpConfig& config) {
  if (command.interface.empty()) throw config::Error("--via someip: --interface is missing");
  if (command.address.empty()) throw config::Error("--via someip: --address is missing");
  SomeIpOptions options;
  options.interface = command.interface;
  options.address = address_of(command.address, "--address");
  if (!command.group.empty()) options.event_group = group_of(command.group);
  std::string discovery_group = config.discovery_group;
  if (discovery_group.empty()) {
    discovery_group = options.address.is_v4() ? service::discovery::kMulticastIpv4 : service::discovery::kMulticastIpv6;
  }
  options.discovery_group = {address_of(discovery_group, "discovery_group"), config.discovery_port};
  for (const auto& [what, address] :
       {std::pair{"discovery_group", options.discovery_group.address},
        std::pair{"--group", options.event_group ? options.event_group->address : options.discovery_group.address}}) {
    if (address.is_v4() != options.address.is_v4()) {
      throw config::Error(std::string(what) + ": not of the same IP version as --address");
    }
  }
  if (!options.discovery_group.address.is_multicast()) throw config::Error("discovery_group: not a multicast group");
  options.first_port = config.first_port;
  options.offer_cycle_s = command.offer_cycle_s;
  options.share_s = command.share_ms * 1e-3;
  options.multicast_hops = config.multicast_hops;
  options.data_id_base = config.data_id_base;
  return options;
}

std::vector<std::uint16_t> instances_of(const SomeIpCommand& command, const VehicleConfig* vehicle) {
  std::vector<std::uint16_t> instances;
  if (command.synthetic.detections > 0) {
    for (unsigned radar = 1; radar <= command.synthetic.radars; ++radar) {
      instances.push_back(static_cast<std::uint16_t>(radar));
    }
  } else {
    for (const RadarConfig& radar : vehicle->radars) instances.push_back(static_cast<std::uint16_t>(radar.id));
    // One instance offers the ego motion of a vehicle without radars.
    if (instances.empty()) instances.push_back(1);
  }
  return instances;
}

void serve_synthetic(const SomeIpCommand& command, const VehicleConfig* vehicle, const PlayOptions& play,
                     SomeIpServer& server) {
  std::vector<MountingPose> mountings(command.synthetic.radars);
  if (vehicle != nullptr) {
    for (const RadarConfig& radar : vehicle->radars) {
      if (radar.id <= mountings.size()) mountings[radar.id - 1] = radar.mounting_pose;
    }
  }
  SyntheticOptions options = command.synthetic;
  options.duration_s = play.duration_s;
  play_synthetic(options, mountings, server);
}

void serve_recordings(const VehicleConfig& vehicle, const PlayOptions& options, double wait_s, SomeIpServer& server) {
  const std::int64_t deadline_ns = runtime::monotonic_now_ns() + static_cast<std::int64_t>(wait_s * 1e9);
  while (wait_s > 0.0 && !server.has_subscriber() && !runtime::stop_signalled()) {
    const std::int64_t now_ns = runtime::monotonic_now_ns();
    if (now_ns >= deadline_ns) throw std::runtime_error("no client subscribed to the detections of any radar");
    server.serve_until(std::min(deadline_ns, now_ns + 10'000'000));
  }
  SomeIpSender sender(vehicle, server);
  const PlayResult result = play(options, sender);
  std::printf("replayed %.1f s, %llu malformed\n", result.recorded_s,
              static_cast<unsigned long long>(result.malformed));
}

void print(const SomeIpServer& server) {
  const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  const ServerCounts& sent = server.counts();
  const someip::SdStatistics& discovery = server.discovery();
  std::printf(
      "served %llu detection lists and %llu ego motions in %llu datagrams (%.1f MB); "
      "%llu events without a subscriber, %llu datagrams rejected by the kernel\n",
      number(sent.detection_lists), number(sent.ego_motions), number(sent.datagrams),
      static_cast<double>(sent.bytes) * 1e-6, number(sent.unheard), number(sent.refused));
  std::printf(
      "discovery: %llu subscriptions acknowledged, %llu refused, %llu expired, %llu clients rebooted, "
      "%llu malformed datagrams\n",
      number(discovery.acknowledged), number(discovery.refused), number(discovery.expired),
      number(discovery.client_reboots), number(discovery.malformed));
}

}  // namespace

void add_someip_options(CLI::App& app, SomeIpCommand& command) {
  app.add_option("--interface", command.interface, "Network interface of the server (someip)")->type_name("NAME");
  app.add_option("--address", command.address, "This machine's IPv4 or IPv6 address on the interface (someip)")
      ->type_name("ADDRESS");
  app.add_option("--group", command.group, "Sends events by multicast to this group (someip)")->type_name("GROUP:PORT");
  app.add_option("--offer-cycle", command.offer_cycle_s, "Seconds between offers (someip)")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  app.add_option("--share-datagrams", command.share_ms,
                 "Milliseconds that short events wait to share a datagram (someip)")
      ->check(CLI::Range(0.0, 100.0));
  app.add_option("--synthetic", command.synthetic.detections,
                 "Serves synthetic scans of this many detections, without recordings (someip)")
      ->check(CLI::Range(1u, static_cast<unsigned>(kMaxDetections)));
  app.add_option("--rate", command.synthetic.rate_hz, "Scans per second of each synthetic radar")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  app.add_option("--radars", command.synthetic.radars, "Number of synthetic radars")
      ->check(CLI::Range(1u, static_cast<unsigned>(kMaxRadars)))
      ->capture_default_str();
  app.add_flag("--together", command.synthetic.together, "All synthetic radars measure at the same time");
}

void serve_someip(const SomeIpCommand& command, const SomeIpConfig& config, const VehicleConfig* vehicle,
                  const PlayOptions& play, double wait_s) {
  const bool synthetic = command.synthetic.detections > 0;
  if (synthetic == !play.files.empty()) throw config::Error("--via someip: either recordings or --synthetic");
  if (play.step_s > 0.0)
    throw config::Error("--step: not with --via someip, because subscriptions would expire meanwhile");
  SomeIpServer server(server_options(command, config), instances_of(command, vehicle));
  std::printf("serving %zu instance(s) at %s\n", instances_of(command, vehicle).size(), command.address.c_str());
  std::fflush(stdout);
  if (synthetic) {
    serve_synthetic(command, vehicle, play, server);
  } else {
    serve_recordings(*vehicle, play, wait_s, server);
  }
  server.stop();
  print(server);
}

}  // namespace boresight::replay
