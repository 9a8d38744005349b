#include "services/ingest_gateway/core/gateway.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

#include "interfaces/wire/boresight_service.hpp"
#include "services/ingest_gateway/codecs/ars408.hpp"
#include "services/ingest_gateway/codecs/ars548.hpp"
#include "services/ingest_gateway/codecs/boresight_service.hpp"
#include "services/ingest_gateway/codecs/srr520.hpp"
#include "services/ingest_gateway/codecs/table_ego.hpp"
#include "services/ingest_gateway/codecs/table_radar.hpp"
#include "services/ingest_gateway/codecs/toyota_ego.hpp"
#include "services/ingest_gateway/codecs/toyota_radar.hpp"

namespace boresight::ingest {

namespace {

constexpr std::int64_t kTick_ns = 5'000'000;

std::unique_ptr<Decoder> make_decoder(const RadarConfig& radar, const Mappings& mappings) {
  switch (radar.profile) {
    case RadarProfile::kToyota:
      return std::make_unique<ToyotaRadar>();
    case RadarProfile::kArs548:
      return std::make_unique<ars548::Ars548>(radar.e2e);
    case RadarProfile::kSrr520:
      return std::make_unique<Srr520>();
    case RadarProfile::kArs408:
      return std::make_unique<Ars408>(radar.sensor_id);
    case RadarProfile::kMapping: {
      const auto found = mappings.radars.find(radar.id);
      if (found == mappings.radars.end()) throw std::invalid_argument("no mapping for radar " + radar.name);
      return std::make_unique<TableRadar>(found->second);
    }
    case RadarProfile::kBoresight:
      break;
  }
  return std::make_unique<service::DetectionList>();
}

std::unique_ptr<Decoder> make_ego_decoder(const EgoConfig& ego, const Mappings& mappings) {
  switch (ego.profile) {
    case EgoProfile::kToyota:
      return std::make_unique<ToyotaEgo>();
    case EgoProfile::kSrr520:
      return std::make_unique<Srr520>();
    case EgoProfile::kMapping:
      if (!mappings.ego) throw std::invalid_argument("no mapping for the ego signals");
      return std::make_unique<TableEgo>(*mappings.ego);
    case EgoProfile::kBoresight:
      break;
  }
  return std::make_unique<service::EgoEvent>();
}

/// The radar whose lists carry the vehicle's motion and are decoded in any case.
std::optional<std::uint32_t> radar_with_ego_signals(const VehicleConfig& vehicle) {
  if (vehicle.ego.profile != EgoProfile::kSrr520) return std::nullopt;
  for (const RadarConfig& radar : vehicle.radars) {
    if (radar.profile == RadarProfile::kSrr520 && radar.source.interface == vehicle.ego.source.interface) {
      return radar.id;
    }
  }
  return std::nullopt;
}

}  // namespace

Gateway::Gateway(const VehicleConfig& vehicle, Sink& sink, const Mappings& mappings,
                 const ContradictionConfig& contradiction)
    : sink_(sink),
      ego_(vehicle.ego),
      ego_source_(nullptr, make_ego_decoder(vehicle.ego, mappings), static_cast<EgoReceiver&>(*this), sink),
      someip_(sink),
      feed_(vehicle) {
  ego_source_id_ = radar_with_ego_signals(vehicle).value_or(ego_source_.id());
  if (vehicle.ego.source.link == LinkKind::kSomeIp) {
    add_someip(ego_source_, vehicle.ego.source, wire::boresight_service::kEventEgoMotion,
               wire::boresight_service::kEventgroupEgoMotion, vehicle.ego.e2e);
  } else if (ego_source_id_ == ego_source_.id()) {
    can_.push_back({vehicle.ego.source.interface, &ego_source_});
  }
  for (const RadarConfig& radar : vehicle.radars) add_radar(radar, mappings, contradiction);
  someip_.prepare();
  for (const auto& discovery : discoveries_) discovery->prepare();
}

void Gateway::add_radar(const RadarConfig& radar, const Mappings& mappings, const ContradictionConfig& contradiction) {
  sources_.push_back(std::make_unique<Source>(&radar, make_decoder(radar, mappings), static_cast<EgoReceiver&>(*this),
                                              sink_, contradiction));
  Source& source = *sources_.back();
  const SourceAddress& address = radar.source;
  switch (address.link) {
    case LinkKind::kCan:
      can_.push_back({address.interface, &source});
      break;
    case LinkKind::kUdp:
      udp_.push_back({{recording::ip_or_unspecified(address.address), address.port},
                      recording::ip_or_unspecified(address.sender),
                      &source});
      break;
    case LinkKind::kSomeIp:
      add_someip(source, address, wire::boresight_service::kEventDetectionList,
                 wire::boresight_service::kEventgroupDetections, radar.e2e);
      break;
  }
}

void Gateway::add_someip(Source& source, const SourceAddress& address, std::uint16_t event, std::uint16_t eventgroup,
                         const E2eConfig& e2e) {
  const std::size_t index = someip_.add(source, event, e2e);
  someip_ports_.push_back(address.port);
  if (!address.sender.empty()) {
    someip_.set_server(index, recording::Endpoint{recording::ip_or_unspecified(address.sender), address.sender_port});
    return;
  }
  auto found = std::find_if(discoveries_.begin(), discoveries_.end(), [&](const auto& d) { return d->is_on(address); });
  if (found == discoveries_.end()) {
    found = discoveries_.insert(found, std::make_unique<Discovery>(address, someip_, sink_));
  }
  (*found)->add(index, address, eventgroup);
}

Gateway::~Gateway() = default;

void Gateway::take(const recording::Frame& frame, const FrameStamp& stamp) {
  if (!started_) {
    start(stamp.received_ns);
    stamps_tell_time_ = true;
  }
  // If the clock went back, ticks at once instead of waiting until the former time is reached again.
  if (stamps_tell_time_ && std::abs(stamp.received_ns - last_tick_ns_) >= kTick_ns) tick(stamp.received_ns);
  if (frame.kind == recording::FrameKind::kUdp) {
    take_udp(frame, stamp);
  } else if (!frame.can_remote) {
    take_can(frame, stamp);
  }
}

void Gateway::finish() {
  // No tick for discovery: a silent server after the end of a recording is no fault.
  constexpr std::int64_t kLong_ns = 10'000'000'000;
  tick_sources(last_tick_ns_ + kLong_ns);
}

void Gateway::tick(std::int64_t now_ns) {
  tick_sources(now_ns);
  for (const auto& discovery : discoveries_) discovery->tick(now_ns);
}

void Gateway::tick_sources(std::int64_t now_ns) {
  last_tick_ns_ = now_ns;
  ego_source_.tick(now_ns);
  for (const auto& source : sources_) source->tick(now_ns);
  someip_.tick(now_ns);
}

void Gateway::start(std::int64_t now_ns) {
  started_ = true;
  last_tick_ns_ = now_ns;
  feed_.start(sink_);
  for (const auto& discovery : discoveries_) discovery->start(now_ns);
}

void Gateway::network_is_up(std::int64_t now_ns) {
  for (const auto& discovery : discoveries_) discovery->network_is_up(now_ns);
}

void Gateway::stop() {
  for (const auto& discovery : discoveries_) discovery->stop(last_tick_ns_);
}

void Gateway::take_can(const recording::Frame& frame, const FrameStamp& stamp) {
  const std::string_view interface = frame.interface_name();
  for (const CanRoute& route : can_) {
    if (route.interface.empty() || route.interface == interface) route.source->take(frame, stamp);
  }
}

bool Gateway::is_for_someip(const recording::Frame& frame) const {
  const auto is_event_port = [&](std::uint16_t port) { return port == frame.destination.port; };
  return someip_.knows(frame.source) || std::any_of(someip_ports_.begin(), someip_ports_.end(), is_event_port);
}

void Gateway::take_udp(const recording::Frame& frame, const FrameStamp& stamp) {
  bool known_port = false;
  for (const UdpRoute& route : udp_) {
    if (route.destination.port != 0 && route.destination.port != frame.destination.port) continue;
    if (!route.destination.address.is_unspecified() && route.destination.address != frame.destination.address) continue;
    known_port = true;
    if (route.sender.is_unspecified() || route.sender == frame.source.address) {
      route.source->take(frame, stamp);
      return;
    }
  }
  bool is_discovery = false;
  for (const auto& discovery : discoveries_) {
    if (!discovery->is_for(frame)) continue;
    discovery->take(frame, stamp.received_ns);
    is_discovery = true;
  }
  if (is_discovery) return;
  if (is_for_someip(frame)) {
    someip_.take(frame, stamp, [&](std::size_t index) {
      for (const auto& discovery : discoveries_) discovery->event_received(index, stamp.received_ns);
    });
  } else if (known_port) {
    sink_.fault(Fault::kWireUnknown, "datagram to a radar's port from an unknown sender", 0);
  }
}

void Gateway::take_ego(std::uint32_t source_id, const EgoReading& reading, const FrameStamp& reception) {
  if (source_id != ego_source_id_) return;
  const EgoAssembler::Result result = ego_.take(reading, reception);
  if (result.time_jumped) sink_.fault(Fault::kTimeJump, "ego signals: the clock of their frames went back", source_id);
  if (!result.rejected.empty()) sink_.fault(Fault::kWireValue, result.rejected, source_id);
  if (!result.complete) return;
  EgoMotion* const out = sink_.begin_ego();
  if (out == nullptr) return;  // already counted as a failed loan
  ego_.write(*out);
  latest_ego_ = *out;
  latest_ego_.header.measurement_time_ns = ego_.time().time_ns;
  has_ego_ = true;
  sink_.publish_ego(ego_.time());
  feed_.send(latest_ego_, reception.received_ns, sink_);
}

const EgoMotion* Gateway::latest_ego(std::int64_t time_ns) const {
  constexpr std::int64_t kMaxAge_ns = 300'000'000;
  const bool is_fresh = has_ego_ && std::abs(time_ns - latest_ego_.header.measurement_time_ns) <= kMaxAge_ns;
  return is_fresh ? &latest_ego_ : nullptr;
}

}  // namespace boresight::ingest
