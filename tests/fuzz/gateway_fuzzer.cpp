// A gateway with a radar of every profile receives frames of every kind on every link, in any order, with clocks that
// jump.
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "interfaces/wire/ars408.hpp"
#include "interfaces/wire/ars548.hpp"
#include "interfaces/wire/srr520.hpp"
#include "interfaces/wire/toyota.hpp"
#include "services/common/someip/big_endian.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "tests/fuzz/checked_sink.hpp"
#include "tests/fuzz/mapping_texts.hpp"

namespace {

using namespace boresight;

constexpr std::array<std::uint32_t, 32> kIds{
    0x024, 0x025, 0x0AA, 0x210, 0x211, 0x21F, 0x220, 0x22F, 700,   800,   900,   901,   1100,  1101,  1200, 1201,
    0x200, 0x201, 0x600, 0x701, 0x702, 0x60A, 0x60B, 0x60C, 0x60D, 0x650, 0x751, 0x752, 0x65A, 0x65B, 0,    0x9FFFFFFF};

RadarConfig radar(std::uint32_t id, RadarProfile profile, const char* interface) {
  RadarConfig radar;
  radar.id = id;
  radar.name = "radar";
  radar.profile = profile;
  radar.source.interface = interface;
  return radar;
}

/// `ego` is the number of an EgoProfile.
VehicleConfig vehicle(unsigned ego) {
  VehicleConfig vehicle;
  vehicle.ego.profile = static_cast<EgoProfile>(ego);
  vehicle.ego.source.interface = "can0";
  vehicle.radars = {radar(1, RadarProfile::kToyota, "can0"),  radar(2, RadarProfile::kSrr520, "can0"),
                    radar(3, RadarProfile::kArs408, "can1"),  radar(4, RadarProfile::kArs408, "can1"),
                    radar(5, RadarProfile::kMapping, "can1"), radar(6, RadarProfile::kArs548, "")};
  vehicle.radars[3].sensor_id = 5;
  vehicle.radars[2].ego_feed = vehicle.radars[5].ego_feed = true;
  vehicle.radars[2].output = Ars408Output::kObjects;
  SourceAddress& ars548 = vehicle.radars[5].source;
  ars548.link = LinkKind::kUdp;
  ars548.address = "239.0.0.1";
  ars548.port = 42102;
  ars548.sender = "10.13.1.113";
  SourceAddress service;
  service.link = LinkKind::kSomeIp;
  service.address = "10.0.0.2";
  service.port = 30501;
  service.instance = 2;
  // Reassembly takes a megabyte, so that only one vehicle has it; someip_receiver_fuzzer tests it alone.
  if (vehicle.ego.profile == EgoProfile::kBoresight) {
    vehicle.ego.source = service;
    vehicle.radars.push_back(radar(7, RadarProfile::kBoresight, ""));
    vehicle.radars.back().source = service;
  }
  return vehicle;
}

const ingest::Mappings& mappings() {
  static const ingest::Mappings mappings = [] {
    const auto load = [](const std::string&) { return ingest::dbc::parse_dbc(fuzz::kDbc, "fuzz.dbc"); };
    const auto open = [](std::string_view text) { return config::Reader::parse(text, "fuzz.toml"); };
    ingest::Mappings made;
    made.radars[5] = ingest::read_radar_mapping(open(fuzz::kRadarMappings[1]), load);
    made.ego = ingest::read_ego_mapping(open(fuzz::kEgoMappings[0]), load);
    return made;
  }();
  return mappings;
}

/// A CAN id that a decoder uses; bit 31 marks an extended id.
std::uint32_t id_of(std::uint8_t choice) {
  static const std::vector<std::uint32_t> ids = [] {
    std::vector<std::uint32_t> all(kIds.begin(), kIds.end());
    const auto add = [&](const auto& message) {
      all.push_back(message.frame.id | (message.frame.extended ? 0x80000000u : 0u));
    };
    for (const auto& message : mappings().radars.at(5).messages) add(message);
    for (const auto& message : mappings().ego->messages) add(message);
    return all;
  }();
  return ids[choice % ids.size()];
}

/// An ARS548 message (detections, objects or status) of its right length; the input sets the content at its beginning.
std::span<const std::uint8_t> ars548(std::uint8_t choice, std::span<const std::uint8_t> content) {
  namespace layout = wire::ars548;
  static std::array<std::uint8_t, layout::kDetectionListBytes> bytes;
  const bool is_list = choice % 2 == 0;
  const auto message = std::span(bytes).first(is_list ? layout::kDetectionListBytes : layout::kStatusBytes);
  std::fill(message.begin(), message.end(), std::uint8_t{0});
  std::copy_n(content.begin(), std::min(content.size(), message.size() - layout::kShortHeaderBytes),
              message.begin() + layout::kShortHeaderBytes);
  boresight::write_u16(message.data() + 2, is_list ? layout::kMethodDetectionList : layout::kMethodStatus);
  boresight::write_u32(message.data() + 4, static_cast<std::uint32_t>(message.size() - layout::kShortHeaderBytes));
  if (is_list) boresight::write_u32(message.data() + layout::kNumberOfDetections, 3u * choice);
  return message;
}

/// One gateway receives many inputs, some seconds apart, since making a gateway takes long. An input can request a new
/// gateway, so that a single failing input can be reproduced.
struct Drive {
  explicit Drive(unsigned ego) : gateway(vehicle(ego), sink, mappings()) {}
  fuzz::CheckedSink sink;
  ingest::Gateway gateway;
  ingest::RecordingClock clock;
  std::int64_t recorded_ns = 1'700'000'000'000'000'000, now_ns = 1'000'000'000;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::array<std::unique_ptr<Drive>, 4> drives;
  static_cast<void>(id_of(0));  // takes its memory
  fuzz::Input input(data, size);
  const std::uint8_t which = input.u8();
  std::unique_ptr<Drive>& drive = drives[which % 4];
  if (which / 4 == 0x2A || drive == nullptr) drive = std::make_unique<Drive>(which % 4);
  auto& [sink, gateway, clock, recorded_ns, now_ns] = *drive;
  const fuzz::NoAllocation guard;
  while (!input.empty()) {
    const std::uint8_t choice = input.u8();
    recording::Frame frame;
    std::array<std::uint8_t, 64> bytes{};
    if (choice < 224) {
      frame.can_id = id_of(choice) & 0x1FFFFFFFu;
      frame.can_extended = id_of(choice) >> 31 != 0;
      const std::uint8_t how = input.u8();
      frame.kind = (how & 0x80) != 0 ? recording::FrameKind::kCanFd : recording::FrameKind::kCan;
      frame.set_interface((how & 0x40) != 0 ? "can1" : "can0");
      const std::size_t length = (how & 0x20) != 0 ? how % 8u * 8u + 8u : how % 9u;
      const auto content = input.bytes(length);
      std::copy(content.begin(), content.end(), bytes.begin());
      frame.payload = std::span(bytes).first(length);
      frame.can_remote = (how & 0x1F) == 0x1F;
      if (frame.can_id < 0x240 && frame.can_id != 0x0AA && length > 0) {
        bytes[length - 1] = wire::toyota::checksum(frame.can_id, frame.payload);
      }
    } else if (choice < 240) {
      frame.kind = recording::FrameKind::kUdp;
      frame.source = {recording::IpAddress::v4(choice < 238 ? 0x0A0D0171 : 0x0A0D0172), 42102};
      frame.destination = {recording::IpAddress::v4(0xEF000001), 42102};
      const std::uint8_t how = input.u8();
      frame.payload = ars548(how, input.bytes(input.u8()));
    } else if (choice < 248) {
      frame.kind = recording::FrameKind::kUdp;
      frame.source = {recording::IpAddress::v4(0x0A000001), static_cast<std::uint16_t>(choice < 244 ? 30601 : 30490)};
      frame.destination = {recording::IpAddress::v4(0x0A000002),
                           static_cast<std::uint16_t>(choice < 244 ? 30501 : 30490)};
      frame.payload = input.bytes(input.u8());
    } else if (choice < 252) {
      now_ns += input.u8() * std::int64_t{10'000'000};
      gateway.tick(now_ns);
      continue;
    } else {
      // The recording's clock jumps by up to ± an hour and a half.
      recorded_ns += static_cast<std::int16_t>(input.number(2)) * std::int64_t{164'000'000};
      continue;
    }
    bool jumped = false;
    gateway.take(frame, clock.map(recorded_ns += 300'000, now_ns += 300'000, jumped));
    sink.require_at_rest();
  }
  gateway.finish();
  gateway.stop();
  now_ns += 12'000'000'000;
  clock.reset();
  sink.require_at_rest();
  return 0;
}
