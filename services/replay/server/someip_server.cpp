#include "services/replay/server/someip_server.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <poll.h>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/core/radar_service.hpp"

namespace boresight::replay {

namespace service = wire::boresight_service;

namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kSecond_ns = 1'000'000'000;

someip::SdServerConfig discovery_config(const SomeIpOptions& options, const std::vector<std::uint16_t>& instances) {
  someip::SdServerConfig config;
  config.service = radar_service();
  for (const std::uint16_t number : instances) {
    config.instances.push_back({number, {options.address, static_cast<std::uint16_t>(options.first_port + number)}});
  }
  config.event_group = options.event_group;
  config.cycle_ns = static_cast<std::int64_t>(options.offer_cycle_s * 1e9);
  return config;
}

DataIds data_ids(std::uint32_t base, std::uint16_t instance) {
  const std::uint32_t offset = base - (std::uint32_t{service::kServiceId} << 16);
  return {service::data_id(instance, service::kEventDetectionList) + offset,
          service::data_id(instance, service::kEventEgoMotion) + offset};
}

}  // namespace

SomeIpServer::SomeIpServer(const SomeIpOptions& options, const std::vector<std::uint16_t>& instances)
    : options_(options),
      discovery_({options.interface, options.address, options.discovery_group, options.multicast_hops},
                 discovery_config(options, instances),
                 {[this](const recording::IpAddress& from, std::string_view what) { report(from, what); }, {}}),
      flush_ns_(kNever) {
  for (const std::uint16_t number : instances) {
    const recording::Endpoint local{options.address, static_cast<std::uint16_t>(options.first_port + number)};
    instances_.push_back({number,
                          runtime::UdpSocket::bound_to(local, options.interface, options.multicast_hops),
                          EventEncoder(data_ids(options.data_id_base, number)),
                          {}});
  }
}

SomeIpServer::~SomeIpServer() {
  stop();
}

void SomeIpServer::serve_until(std::int64_t due_ns) {
  const std::array<int, 2> descriptors = discovery_.descriptors();
  std::array<pollfd, 2> watched{{{descriptors[0], POLLIN, 0}, {descriptors[1], POLLIN, 0}}};
  while (true) {
    std::int64_t now_ns = runtime::monotonic_now_ns();
    discovery_.tick(now_ns);
    if (now_ns >= flush_ns_) flush();
    // Longest delay of a stop signal that arrives between the check and the call.
    constexpr std::int64_t kMaxStopDelay_ns = 100'000'000;
    const std::int64_t next_ns = std::min({due_ns, discovery_.next_due_ns(), flush_ns_, now_ns + kMaxStopDelay_ns});
    const std::int64_t wait_ns = std::max<std::int64_t>(next_ns - now_ns, 0);
    const timespec wait{.tv_sec = wait_ns / kSecond_ns, .tv_nsec = wait_ns % kSecond_ns};
    if (ppoll(watched.data(), watched.size(), &wait, nullptr) > 0) discovery_.receive();
    now_ns = runtime::monotonic_now_ns();
    if (now_ns >= due_ns || runtime::stop_signalled()) return;
  }
}

void SomeIpServer::report(const recording::IpAddress& from, std::string_view what) const {
  if (discovery_.statistics().malformed > 1) return;
  runtime::log::warning("{}: {}; further faults are counted, not logged", recording::to_text(from), what);
}

bool SomeIpServer::send(std::uint16_t number, const RadarScan& scan, const SensorTime& time) {
  bool heard = false;
  for (Instance& instance : instances_) {
    if (instance.number != number) continue;
    const auto to = destinations(instance, service::kEventgroupDetections);
    // Counters do not advance without a subscriber, who would detect a loss otherwise.
    if (to.empty()) continue;
    deliver(instance, to, instance.encoder.detection_list(scan, time));
    heard = true;
  }
  ++(heard ? counts_.detection_lists : counts_.unheard);
  return heard;
}

bool SomeIpServer::send(const EgoMotion& ego, const SensorTime& time) {
  bool heard = false;
  for (Instance& instance : instances_) {
    const auto to = destinations(instance, service::kEventgroupEgoMotion);
    if (to.empty()) continue;
    deliver(instance, to, instance.encoder.ego_motion(ego, time));
    heard = true;
  }
  ++(heard ? counts_.ego_motions : counts_.unheard);
  return heard;
}

std::span<const recording::Endpoint> SomeIpServer::destinations(const Instance& instance, std::uint16_t eventgroup) {
  return discovery_.destinations(instance.number, eventgroup, runtime::monotonic_now_ns());
}

void SomeIpServer::deliver(Instance& instance, std::span<const recording::Endpoint> destinations,
                           std::span<const std::uint8_t> message) {
  for (const recording::Endpoint& to : destinations) {
    if (options_.share_s > 0.0 && fits_one_datagram(message)) {
      share(instance, to, message);
      continue;
    }
    // Keeps the order of events.
    if (const auto waiting = instance.waiting.find(to); waiting != instance.waiting.end()) {
      if (!waiting->second.empty()) send_datagram(instance, to, waiting->second.content());
      waiting->second.clear();
    }
    for_each_datagram(message, [&](std::span<const std::uint8_t> datagram) { send_datagram(instance, to, datagram); });
  }
}

void SomeIpServer::share(Instance& instance, const recording::Endpoint& to, std::span<const std::uint8_t> message) {
  SharedDatagram& shared = instance.waiting[to];
  if (!shared.add(message)) {
    send_datagram(instance, to, shared.content());
    shared.clear();
    static_cast<void>(shared.add(message));
  }
  flush_ns_ = std::min(flush_ns_, runtime::monotonic_now_ns() + static_cast<std::int64_t>(options_.share_s * 1e9));
}

void SomeIpServer::send_datagram(const Instance& instance, const recording::Endpoint& to,
                                 std::span<const std::uint8_t> datagram) {
  if (!instance.socket.send(to, datagram)) {
    ++counts_.refused;
    return;
  }
  ++counts_.datagrams;
  counts_.bytes += datagram.size();
}

void SomeIpServer::flush() {
  for (Instance& instance : instances_) {
    for (auto& [to, shared] : instance.waiting) {
      if (!shared.empty()) send_datagram(instance, to, shared.content());
    }
    // Forgets subscribers that have ended.
    instance.waiting.clear();
  }
  flush_ns_ = kNever;
}

void SomeIpServer::stop() {
  flush();
  discovery_.stop();
}

bool SomeIpServer::has_subscriber() {
  return std::any_of(instances_.begin(), instances_.end(), [this](const Instance& instance) {
    return !destinations(instance, service::kEventgroupDetections).empty();
  });
}

}  // namespace boresight::replay
