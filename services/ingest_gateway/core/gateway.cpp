#include "services/ingest_gateway/core/gateway.hpp"

#include <array>
#include <charconv>

#include "services/ingest_gateway/codecs/ars548.hpp"

namespace boresight::ingest {

namespace {

/// Dotted IPv4 to a number in host byte order; 0 for an empty text. The vehicle file has been checked before.
std::uint32_t parse_ipv4(std::string_view text) {
  std::uint32_t address = 0;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (at < end) {
    std::uint32_t part = 0;
    const auto result = std::from_chars(at, end, part);
    if (result.ec != std::errc{}) return 0;
    address = address << 8 | (part & 0xFFu);
    at = result.ptr + 1;
  }
  return address;
}

}  // namespace

Gateway::Gateway(const VehicleConfig& vehicle, Sink& sink)
    : sink_(sink), ego_interface_(vehicle.ego.source.interface), ego_(vehicle.ego) {
  for (const RadarConfig& radar : vehicle.radars) {
    const auto latency_ns = static_cast<std::int64_t>(radar.latency_s * 1e9);
    if (radar.profile == RadarProfile::kToyota) {
      can_radars_.push_back({radar.id, radar.source.interface, latency_ns, {}});
    } else {
      udp_radars_.push_back(
          {radar.id, parse_ipv4(radar.source.address), parse_ipv4(radar.source.sender), radar.source.port, latency_ns});
    }
  }
}

Gateway::~Gateway() = default;

void Gateway::take(const recording::Frame& frame, const FrameStamp& stamp) {
  if (frame.kind == recording::FrameKind::kUdp) {
    take_udp(frame, stamp);
  } else if (!frame.can_remote) {
    take_can(frame, stamp);
  }
}

void Gateway::take_can(const recording::Frame& frame, const FrameStamp& stamp) {
  const std::string_view interface = frame.interface_name();
  if (interface == ego_interface_) {
    std::string_view problem;
    const DecodeResult result = ego_.take(frame.can_id, frame.payload, stamp.received_ns, problem);
    if (result == DecodeResult::kComplete) {
      if (EgoMotion* const out = sink_.begin_ego()) {
        ego_.write(*out);
        sink_.publish_ego({ego_.stamp_ns(), stamp.source});
      }
    } else {
      reject(result, problem, 0);
    }
  }
  for (CanRadar& radar : can_radars_) {
    if (radar.interface == interface) take_radar_frame(radar, frame, stamp);
  }
}

void Gateway::take_radar_frame(CanRadar& radar, const recording::Frame& frame, const FrameStamp& stamp) {
  // Twice at the most: a frame of the next cycle first ends an incomplete one and is then taken itself.
  for (int attempt = 0; attempt < 2; ++attempt) {
    std::string_view problem;
    const DecodeResult result = radar.codec.take(frame.can_id, frame.payload, stamp.received_ns, problem);
    if (result != DecodeResult::kComplete) {
      reject(result, problem, radar.id);
      return;
    }
    finish_cycle(radar);
    if (radar.codec.missing_frames() == 0) return;
    sink_.fault(Fault::kWireLength, "Toyota radar: frames of a cycle are missing", radar.id);
  }
}

void Gateway::finish_cycle(CanRadar& radar) {
  const MeasurementTime time{radar.codec.stamp_ns() - radar.latency_ns, TimeSource::kLinkArrival};
  RadarScan* const scan = sink_.begin_scan();
  if (scan == nullptr) {
    radar.codec.discard();
    return;
  }
  radar.codec.write_scan(*scan);
  sink_.publish_scan(radar.id, time);
}

void Gateway::take_udp(const recording::Frame& frame, const FrameStamp& stamp) {
  const UdpRadar* match = nullptr;
  bool known_port = false;
  for (const UdpRadar& radar : udp_radars_) {
    if (radar.port != frame.destination_port || radar.destination_ipv4 != frame.destination_ipv4) continue;
    known_port = true;
    if (radar.sender_ipv4 == 0 || radar.sender_ipv4 == frame.source_ipv4) match = &radar;
  }
  if (match == nullptr) {
    if (known_port) sink_.fault(Fault::kWireUnknown, "datagram to a radar's port from an unknown sender", 0);
    return;
  }
  std::string_view problem;
  const DecodeResult check = ars548::check(frame.payload, problem);
  if (check != DecodeResult::kComplete) {
    reject(check, problem, match->id);
    return;
  }
  RadarScan* const scan = sink_.begin_scan();
  if (scan == nullptr) return;  // counted where the memory was refused
  const ars548::SensorTime time = ars548::decode(frame.payload, *scan);
  sink_.publish_scan(match->id, measurement_time(time.epoch_ns, time.synchronised, stamp, match->latency_ns));
}

void Gateway::reject(DecodeResult result, std::string_view problem, std::uint32_t radar_id) {
  switch (result) {
    case DecodeResult::kBadLength:
      sink_.fault(Fault::kWireLength, problem, radar_id);
      break;
    case DecodeResult::kBadValue:
      sink_.fault(Fault::kWireValue, problem, radar_id);
      break;
    case DecodeResult::kUnknownMessage:
      sink_.fault(Fault::kWireUnknown, problem, radar_id);
      break;
    case DecodeResult::kAccepted:
    case DecodeResult::kComplete:
    case DecodeResult::kIgnored:
      break;
  }
}

}  // namespace boresight::ingest
