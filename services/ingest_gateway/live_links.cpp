#include "services/ingest_gateway/live_links.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/runtime/socket_address.hpp"
#include "services/ingest_gateway/links/network_watch.hpp"

namespace boresight::ingest {

void Links::add(std::unique_ptr<Link> link) {
  entries_.push_back(std::make_unique<Entry>(Entry{std::move(link)}));
  static_cast<void>(entries_.back()->link->open());
  watch(*entries_.back());
}

void Links::add_live(const VehicleConfig& vehicle) {
  // Without notice of changes, a gateway whose interface was replaced would miss up to one more second of multicast.
  add(std::make_unique<NetworkWatch>([this] { keep_open(); }, events_));
  std::vector<SourceAddress> sources{vehicle.ego.source};
  for (const RadarConfig& radar : vehicle.radars) sources.push_back(radar.source);
  for (const SourceAddress& source : sources) {
    if (source.link == LinkKind::kCan) {
      const auto same = [&](const CanLink* link) { return link->interface() == source.interface; };
      if (std::any_of(can_.begin(), can_.end(), same)) continue;
      auto link = std::make_unique<CanLink>(source.interface, events_);
      can_.push_back(link.get());
      add(std::move(link));
      continue;
    }
    const recording::IpAddress address = recording::ip_or_unspecified(source.address);
    add_udp({address, source.port}, source.interface, Sharing::kOrdinary);
    if (source.link == LinkKind::kSomeIp) {
      add_udp({address, source.discovery_port}, source.interface, Sharing::kPolite);
      add_udp({recording::ip_or_unspecified(source.discovery_address), source.discovery_port}, source.interface,
              Sharing::kOrdinary);
    }
  }
}

void Links::add_udp(const recording::Endpoint& local, const std::string& interface, Sharing sharing) {
  for (Udp& udp : udp_) {
    if (udp.local == local && udp.interface == interface) {
      ++udp.users;
      udp.link->add_user();
      return;
    }
  }
  const auto is_known = [&](const Interface& known) { return known.name == interface; };
  if (!interface.empty() && std::none_of(interfaces_.begin(), interfaces_.end(), is_known)) {
    interfaces_.push_back({interface, is_running(interface)});
  }
  auto link = std::make_unique<UdpLink>(local, interface, events_, sharing);
  UdpLink* const added = link.get();
  udp_.push_back({local, interface, added, 1});
  add(std::move(link));
}

void Links::keep_open() {
  const runtime::AllowAllocations not_the_data_path;
  retired_.clear();
  bool came_up = look_at_interfaces();
  for (const auto& entry : entries_) {
    entry->link->check();
    if (entry->link->descriptor() < 0) came_up = entry->link->open() || came_up;
    watch(*entry);
  }
  if (came_up && events_.on_network_up) events_.on_network_up();
}

/// True if one of the interfaces has come up.
bool Links::look_at_interfaces() {
  bool came_up = false;
  for (Interface& interface : interfaces_) {
    const bool was_running = std::exchange(interface.running, is_running(interface.name));
    came_up = came_up || (!was_running && interface.running);
    if (was_running && !interface.running) events_.on_fault(Fault::kLink, "interface " + interface.name + " is down");
  }
  return came_up;
}

void Links::watch(Entry& entry) {
  const int descriptor = entry.link->descriptor();
  if (descriptor == entry.watched) return;
  const runtime::AllowAllocations not_the_data_path;
  if (entry.watched >= 0) node_.remove_descriptor(entry.watched);
  entry.watched = descriptor;
  if (descriptor < 0) return;
  node_.on_readable(descriptor, [this, &entry] {
    entry.link->read();
    watch(entry);
  });
}

void Links::send(const recording::Frame& frame) {
  if (frame.kind != recording::FrameKind::kUdp) {
    for (CanLink* const link : can_) {
      if (link->interface() == frame.interface_name()) link->send(frame);
    }
    return;
  }
  for (const Udp& udp : udp_) {
    if (udp.local == frame.source) {
      udp.link->send(frame.destination, frame.payload);
      return;
    }
  }
  if (!frame.source.address.is_unspecified()) return;
  const bool is_v4 = frame.destination.address.is_v4();
  Socket& sender = is_v4 ? sender_v4_ : sender_v6_;
  if (!sender.is_open())
    sender = Socket(socket(is_v4 ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  sockaddr_storage to{};
  const socklen_t length = runtime::to_sockaddr(frame.destination, to);
  const bool sent = sendto(sender.get(), frame.payload.data(), frame.payload.size(), 0,
                           reinterpret_cast<const sockaddr*>(&to), length) >= 0;
  if (!sent && !sending_fails_) events_.on_fault(Fault::kLink, "cannot send to a sensor: " + last_error());
  sending_fails_ = !sent;
}

void Links::join(const recording::Endpoint& group, std::string_view interface) {
  const runtime::AllowAllocations not_the_data_path;
  add_udp(group, std::string(interface), Sharing::kOrdinary);
}

void Links::leave(const recording::Endpoint& group, std::string_view interface) {
  const runtime::AllowAllocations not_the_data_path;
  const auto found = std::find_if(udp_.begin(), udp_.end(),
                                  [&](const Udp& udp) { return udp.local == group && udp.interface == interface; });
  if (found == udp_.end() || --found->users > 0) return;
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const std::unique_ptr<Entry>& e) { return e->link.get() == found->link; });
  // A datagram of this same link may have caused this call, so the link is only closed, not destroyed.
  found->link->close();
  watch(**entry);
  retired_.push_back(std::move(*entry));
  entries_.erase(entry);
  udp_.erase(found);
}

}  // namespace boresight::ingest
