#include "services/ingest_gateway/core/gateway.hpp"

#include <cstdlib>

#include "services/ingest_gateway/codecs/ars548.hpp"
#include "services/ingest_gateway/codecs/toyota_ego.hpp"
#include "services/ingest_gateway/codecs/toyota_radar.hpp"

namespace boresight::ingest {

namespace {

constexpr std::int64_t kTick_ns = 5'000'000;

std::unique_ptr<Decoder> make_decoder(const RadarConfig& radar) {
  switch (radar.profile) {
    case RadarProfile::kToyota:
      return std::make_unique<ToyotaRadar>();
    case RadarProfile::kArs548:
      break;
  }
  return std::make_unique<ars548::Ars548>();
}

/// The vehicle file has been checked before.
recording::IpAddress address_of(const std::string& text) {
  return recording::parse_ip(text).value_or(recording::IpAddress{});
}

}  // namespace

Gateway::Gateway(const VehicleConfig& vehicle, Sink& sink)
    : sink_(sink),
      ego_interface_(vehicle.ego.source.interface),
      ego_(vehicle.ego),
      ego_source_(nullptr, std::make_unique<ToyotaEgo>(), static_cast<EgoReceiver&>(*this), sink) {
  for (const RadarConfig& radar : vehicle.radars) {
    sources_.push_back(std::make_unique<Source>(&radar, make_decoder(radar), static_cast<EgoReceiver&>(*this), sink_));
    Source* const source = sources_.back().get();
    const SourceAddress& address = radar.source;
    if (address.link == LinkKind::kCan) {
      can_.push_back({address.interface, source});
    } else {
      udp_.push_back({{address_of(address.address), address.port}, address_of(address.sender), source});
    }
  }
}

Gateway::~Gateway() = default;

void Gateway::take(const recording::Frame& frame, const FrameStamp& stamp) {
  // A clock that went back ticks at once, so that nothing waits for the old time to come again.
  if (std::abs(stamp.received_ns - last_tick_ns_) >= kTick_ns) tick(stamp.received_ns);
  if (frame.kind == recording::FrameKind::kUdp) {
    take_udp(frame, stamp);
  } else if (!frame.can_remote) {
    take_can(frame, stamp);
  }
}

void Gateway::finish() {
  constexpr std::int64_t kLong_ns = 10'000'000'000;
  tick(last_tick_ns_ + kLong_ns);
}

void Gateway::tick(std::int64_t now_ns) {
  last_tick_ns_ = now_ns;
  for (const auto& source : sources_) source->tick(now_ns);
}

void Gateway::take_can(const recording::Frame& frame, const FrameStamp& stamp) {
  const std::string_view interface = frame.interface_name();
  if (interface == ego_interface_) ego_source_.take(frame, stamp);
  for (const CanRoute& route : can_) {
    if (route.interface.empty() || route.interface == interface) route.source->take(frame, stamp);
  }
}

void Gateway::take_udp(const recording::Frame& frame, const FrameStamp& stamp) {
  bool known_port = false;
  for (const UdpRoute& route : udp_) {
    if (!route.destination.address.is_unspecified() && route.destination != frame.destination) continue;
    known_port = true;
    if (route.sender.is_unspecified() || route.sender == frame.source.address) {
      route.source->take(frame, stamp);
      return;
    }
  }
  if (known_port) sink_.fault(Fault::kWireUnknown, "datagram to a radar's port from an unknown sender", 0);
}

void Gateway::take_ego(std::uint32_t source_id, const EgoReading& reading, const FrameStamp& reception) {
  if (source_id != ego_source_.id()) return;
  const EgoAssembler::Result result = ego_.take(reading, reception);
  if (result.time_jumped) sink_.fault(Fault::kTimeJump, "ego signals: the clock of their frames went back", source_id);
  if (!result.rejected.empty()) sink_.fault(Fault::kWireValue, result.rejected, source_id);
  if (!result.complete) return;
  EgoMotion* const out = sink_.begin_ego();
  if (out == nullptr) return;  // counted where the memory was refused
  ego_.write(*out);
  sink_.publish_ego(ego_.time());
}

const EgoMotion* Gateway::latest_ego(std::int64_t) const {
  return nullptr;
}

}  // namespace boresight::ingest
