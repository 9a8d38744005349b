#include "services/boresight/decode/made_up_vehicle.hpp"

#include <algorithm>
#include <numbers>

#include "interfaces/messages/header.hpp"
#include "interfaces/wire/boresight_service.hpp"

namespace boresight::decode {

namespace service = wire::boresight_service;

namespace {

constexpr std::uint16_t kArs548Port = 42102;
// A name that no interface can have, for signals of unknown origin.
constexpr const char* kNowhere = "-";

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24 | static_cast<std::uint32_t>(bytes[at + 1]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8 | bytes[at + 3];
}

/// The service instance that sent a message of the event; 0 for other messages and for later segments. The Data ID is
/// the last field of the E2E header.
std::uint16_t instance_of(std::span<const std::uint8_t> datagram, std::uint16_t event) {
  constexpr std::size_t kTypeAt = 14, kTpHeader = 4;
  constexpr std::uint8_t kTpFlag = 0x20;
  if (datagram.size() < service::kBody + kTpHeader) return 0;
  if (read_u32(datagram, 0) != (static_cast<std::uint32_t>(service::kServiceId) << 16 | event)) return 0;
  const bool segmented = (datagram[kTypeAt] & kTpFlag) != 0;
  constexpr std::uint32_t kOffsetMask = 0xFFFFFFF0;
  if (segmented && (read_u32(datagram, service::kSomeIpHeaderBytes) & kOffsetMask) != 0) return 0;
  const std::uint32_t data_id = read_u32(datagram, service::kBody - 4 + (segmented ? kTpHeader : 0));
  const auto instance = static_cast<std::uint16_t>(data_id >> 8 & 0xFF);
  return data_id == service::data_id(instance, event) ? instance : std::uint16_t{0};
}

E2eConfig protection_of(std::uint16_t instance, std::uint16_t event) {
  E2eConfig e2e;
  e2e.required = true;
  e2e.protection = {.profile = e2e::Profile::kP07,
                    .data_id = service::data_id(instance, event),
                    .offset_bytes = service::kE2eOffsetBytes,
                    .max_delta_counter = 50};
  return e2e;
}

SourceAddress someip_from(const Sender& sender) {
  SourceAddress source;
  source.link = LinkKind::kSomeIp;
  source.sender = recording::to_text(sender.endpoint.address);
  source.sender_port = sender.endpoint.port;
  source.instance = sender.instance;
  return source;
}

}  // namespace

const std::vector<std::pair<std::string, RadarProfile>>& profiles() {
  static const std::vector<std::pair<std::string, RadarProfile>> kProfiles = {
      {"ars548", RadarProfile::kArs548}, {"srr520", RadarProfile::kSrr520},   {"ars408", RadarProfile::kArs408},
      {"toyota", RadarProfile::kToyota}, {"mapping", RadarProfile::kMapping}, {"boresight", RadarProfile::kBoresight}};
  return kProfiles;
}

Senders find_senders(recording::Reader& reader, RadarProfile profile) {
  constexpr int kLookedAt = 10'000;
  Senders senders;
  recording::Frame frame;
  for (int looked_at = 0; looked_at < kLookedAt && reader.next(frame);) {
    if (frame.kind != recording::FrameKind::kUdp) continue;
    ++looked_at;
    Sender sender{frame.source, 0};
    if (profile == RadarProfile::kArs548) {
      if (frame.destination.port != kArs548Port) continue;
      sender.endpoint.port = 0;
    } else {
      if (const std::uint16_t instance = instance_of(frame.payload, service::kEventEgoMotion);
          instance != 0 && !senders.ego) {
        senders.ego = {frame.source, instance};
      }
      sender.instance = instance_of(frame.payload, service::kEventDetectionList);
      if (sender.instance < service::kFirstInstance || sender.instance > service::kLastInstance) continue;
    }
    const bool known = std::any_of(senders.radars.begin(), senders.radars.end(), [&](const Sender& other) {
      return other.endpoint == sender.endpoint || (sender.instance != 0 && other.instance == sender.instance);
    });
    if (!known && senders.radars.size() < kMaxRadars) senders.radars.push_back(sender);
  }
  return senders;
}

VehicleConfig made_up_vehicle(const MadeUp& options) {
  VehicleConfig vehicle;
  vehicle.name = "recording";
  vehicle.ego.source.interface = kNowhere;
  RadarConfig radar;
  radar.id = 1;
  radar.name = "radar";
  radar.profile = options.profile;
  radar.sensor_id = options.sensor_id;
  radar.mapping = options.mapping;
  radar.source.interface = options.interface;
  radar.field_of_view = {.azimuth_min_rad = -std::numbers::pi,
                         .azimuth_max_rad = std::numbers::pi,
                         .elevation_min_rad = -std::numbers::pi / 2.0,
                         .elevation_max_rad = std::numbers::pi / 2.0,
                         .range_max_m = 1500.0};
  if (options.profile == RadarProfile::kToyota || options.profile == RadarProfile::kSrr520) {
    vehicle.ego.profile = options.profile == RadarProfile::kToyota ? EgoProfile::kToyota : EgoProfile::kSrr520;
    vehicle.ego.source.interface = options.interface;
  }
  if (options.profile == RadarProfile::kBoresight && options.senders.ego) {
    vehicle.ego.profile = EgoProfile::kBoresight;
    vehicle.ego.source = someip_from(*options.senders.ego);
    vehicle.ego.e2e = protection_of(options.senders.ego->instance, service::kEventEgoMotion);
  }
  if (options.profile == RadarProfile::kArs548) {
    radar.source.link = LinkKind::kUdp;
    radar.source.port = kArs548Port;
  }
  for (const Sender& sender : options.senders.radars) {
    RadarConfig one = radar;
    const std::string text = recording::to_text(sender.endpoint.address);
    if (options.profile == RadarProfile::kBoresight) {
      one.id = sender.instance;
      one.source = someip_from(sender);
      one.e2e = protection_of(sender.instance, service::kEventDetectionList);
    } else {
      one.id = static_cast<std::uint32_t>(vehicle.radars.size() + 1);
      one.source.sender = text;
    }
    one.name = text;
    vehicle.radars.push_back(one);
  }
  if (vehicle.radars.empty() && options.profile != RadarProfile::kBoresight) vehicle.radars.push_back(radar);
  std::sort(vehicle.radars.begin(), vehicle.radars.end(),
            [](const RadarConfig& a, const RadarConfig& b) { return a.id < b.id; });
  return vehicle;
}

}  // namespace boresight::decode
