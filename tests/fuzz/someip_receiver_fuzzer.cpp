// A gateway with sources of the Boresight service receives any datagrams: discovery, whole and segmented events, with
// right and wrong protection.
#include <algorithm>
#include <array>
#include <memory>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/e2e/protector.hpp"
#include "services/common/someip/big_endian.hpp"
#include "services/common/someip/message.hpp"
#include "services/ingest_gateway/codecs/someip/sd.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "tests/fuzz/checked_sink.hpp"

namespace {

using namespace boresight;
namespace service = wire::boresight_service;
namespace someip = ingest::someip;

constexpr std::uint16_t kEventPort = 30501, kServerPort = 30601;
const recording::Endpoint kServer{recording::IpAddress::v4(0x0A000001), kServerPort};
const recording::Endpoint kHere{recording::IpAddress::v4(0x0A000002), kEventPort};

E2eConfig protection(std::uint16_t instance, std::uint16_t event) {
  E2eConfig e2e;
  e2e.required = true;
  e2e.protection.profile = e2e::Profile::kP07;
  e2e.protection.data_id = service::data_id(instance, event);
  e2e.protection.offset_bytes = service::kE2eOffsetBytes;
  return e2e;
}

/// Radar 1 comes from a configured server; radar 2 and the ego motion come from a server found by discovery.
VehicleConfig vehicle() {
  VehicleConfig vehicle;
  SourceAddress address;
  address.link = LinkKind::kSomeIp;
  address.address = "10.0.0.2";
  address.port = kEventPort;
  for (const std::uint16_t instance : {1, 2}) {
    RadarConfig radar;
    radar.id = instance;
    radar.name = "radar";
    radar.profile = RadarProfile::kBoresight;
    radar.source = address;
    radar.source.instance = instance;
    radar.e2e = protection(instance, service::kEventDetectionList);
    vehicle.radars.push_back(radar);
  }
  vehicle.radars[0].source.sender = "10.0.0.1";
  vehicle.radars[0].source.sender_port = kServerPort;
  vehicle.ego.profile = EgoProfile::kBoresight;
  vehicle.ego.source = address;
  vehicle.ego.source.instance = 2;
  vehicle.ego.e2e = protection(2, service::kEventEgoMotion);
  return vehicle;
}

/// Adds a matching header to the payload from the input.
class Sender {
 public:
  /// An event with its E2E header. The body is from the input, corrected for its length.
  std::span<const std::uint8_t> event(bool is_list, std::span<const std::uint8_t> content) {
    const std::size_t body_bytes =
        is_list ? service::detection_list::kMinHeaderBytes + content.size() / service::detection_list::kMinRecordBytes *
                                                                 service::detection_list::kMinRecordBytes
                : service::ego_motion::kMinBodyBytes;
    const auto message = begin(is_list ? service::kEventDetectionList : service::kEventEgoMotion, false,
                               service::kE2eHeaderBytes + body_bytes);
    const auto body = message.subspan(service::kBody);
    std::fill(body.begin(), body.end(), std::uint8_t{0});
    std::copy_n(content.begin(), std::min(content.size(), body.size()), body.begin());
    boresight::write_u16(body.data(), 1);
    if (is_list) {
      namespace list = service::detection_list;
      boresight::write_u16(body.data() + list::kHeaderBytes, list::kMinHeaderBytes);
      boresight::write_u16(body.data() + list::kRecordBytes, list::kMinRecordBytes);
      boresight::write_u16(body.data() + list::kNumberOfDetections,
                           static_cast<std::uint16_t>((body.size() - list::kMinHeaderBytes) / list::kMinRecordBytes));
    } else {
      boresight::write_u16(body.data() + service::ego_motion::kBodyBytes, service::ego_motion::kMinBodyBytes);
    }
    (is_list ? list_protector_ : ego_protector_).protect(message.subspan(service::kProtectedFrom));
    return message;
  }
  /// A segment with offset and length from the input.
  std::span<const std::uint8_t> segment(bool is_list, std::uint16_t session, std::span<const std::uint8_t> content) {
    session_ = session;
    const auto message = begin(is_list ? service::kEventDetectionList : service::kEventEgoMotion, true, content.size());
    std::copy(content.begin(), content.end(), message.begin() + someip::kHeaderBytes);
    return message;
  }
  std::span<const std::uint8_t> discovery(std::span<const std::uint8_t> content) {
    someip::Message header;
    header.service = someip::kSdService;
    header.method = someip::kSdMethod;
    header.session = ++sd_session_;
    header.protocol_version = header.interface_version = 1;
    return write(header, content);
  }
  /// Service `instance` is offered at kServer.
  std::span<const std::uint8_t> offer(std::uint8_t instance, std::uint8_t ttl) {
    const std::array<std::uint8_t, 40> content{0xC0,
                                               0,
                                               0,
                                               0,
                                               0,
                                               0,
                                               0,
                                               16,
                                               1,
                                               0,
                                               0,
                                               0x10,
                                               0x42,
                                               0x53,
                                               0,
                                               instance,
                                               1,
                                               0,
                                               0,
                                               ttl,
                                               0,
                                               0,
                                               0,
                                               0,
                                               0,
                                               0,
                                               0,
                                               12,
                                               0,
                                               9,
                                               4,
                                               0,
                                               10,
                                               0,
                                               0,
                                               1,
                                               0,
                                               0x11,
                                               kServerPort >> 8,
                                               kServerPort & 0xFF};
    return discovery(content);
  }

 private:
  std::span<std::uint8_t> begin(std::uint16_t event, bool is_segment, std::size_t payload_bytes) {
    someip::Message header;
    header.service = service::kServiceId;
    header.method = event;
    header.session = is_segment ? session_ : ++session_;
    header.protocol_version = 1;
    header.interface_version = service::kMajorVersion;
    header.type = someip::MessageType::kNotification;
    header.tp = is_segment;
    const auto message = std::span(bytes_).first(someip::kHeaderBytes + payload_bytes);
    write_header(header, payload_bytes, message.first<someip::kHeaderBytes>());
    return message;
  }
  std::span<const std::uint8_t> write(const someip::Message& header, std::span<const std::uint8_t> content) {
    write_header(header, content.size(), std::span(bytes_).first<someip::kHeaderBytes>());
    std::copy(content.begin(), content.end(), bytes_.begin() + someip::kHeaderBytes);
    return std::span(bytes_).first(someip::kHeaderBytes + content.size());
  }
  e2e::Protector list_protector_{protection(1, service::kEventDetectionList).protection};
  e2e::Protector ego_protector_{protection(2, service::kEventEgoMotion).protection};
  std::uint16_t session_ = 0, sd_session_ = 0;
  std::array<std::uint8_t, 4096> bytes_{};
};

/// Reassembly takes a megabyte, so one gateway receives many inputs, some seconds apart. An input can request a new
/// gateway, so that a single failing input can be reproduced.
struct Drive {
  fuzz::CheckedSink sink;
  Sender sender;
  ingest::Gateway gateway{vehicle(), sink};
  std::int64_t now_ns = 1'000'000'000;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::unique_ptr<Drive> drive;
  fuzz::Input input(data, size);
  if (input.u8() == 0x5A || drive == nullptr) drive = std::make_unique<Drive>();
  auto& [sink, sender, gateway, now_ns] = *drive;
  const fuzz::NoAllocation guard;
  gateway.start(now_ns);
  while (!input.empty()) {
    const std::uint8_t choice = input.u8();
    const bool is_list = (choice & 8) != 0;
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.source = kServer;
    frame.destination = kHere;
    switch (choice & 7u) {
      case 0:
        frame.payload = sender.offer(input.u8() % 4, input.u8() % 4);
        break;
      case 1:
        frame.payload = sender.discovery(input.bytes(input.u8()));
        break;
      case 2:
      case 3:
        frame.payload = sender.event(is_list, input.bytes(input.u8()));
        break;
      case 4:
      case 5:
        frame.payload = sender.segment(is_list, input.u8() % 4, input.bytes(input.u8()));
        break;
      case 6:
        frame.payload = input.bytes(input.u8());
        frame.source.port = static_cast<std::uint16_t>(frame.source.port + (choice >> 7));
        break;
      default:
        now_ns += input.u8() * std::int64_t{20'000'000};
        gateway.tick(now_ns);
        continue;
    }
    if ((choice & 7u) < 2 || (choice & 0x70) == 0x70) {
      frame.source.port = ingest::someip::kSdPort;
      frame.destination.port = ingest::someip::kSdPort;
      if ((choice & 0x80) != 0) frame.destination.address = recording::IpAddress::v4(0xE0F4E0F5);
    }
    gateway.take(frame, {now_ns, 0, TimeSource::kLinkArrival});
    sink.require_at_rest();
    now_ns += 1'000'000;
  }
  gateway.finish();
  gateway.stop();
  now_ns += 12'000'000'000;
  sink.require_at_rest();
  return 0;
}
