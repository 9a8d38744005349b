#include "services/replay/core/event_encoder.hpp"

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/byte_writer.hpp"

namespace boresight::replay {

namespace service = wire::boresight_service;

namespace {

e2e::Config protection(std::uint32_t data_id) {
  e2e::Config config;
  config.profile = e2e::Profile::kP07;
  config.data_id = data_id;
  config.offset_bytes = service::kE2eOffsetBytes;
  return config;
}

constexpr std::size_t kLongestMessage = service::kBody + service::detection_list::kMinHeaderBytes +
                                        kMaxDetections * service::detection_list::kMinRecordBytes;
static_assert(kLongestMessage == 49224);

}  // namespace

EventEncoder::EventEncoder(const DataIds& data_ids)
    : list_protector_(protection(data_ids.detection_list)),
      ego_protector_(protection(data_ids.ego_motion)),
      message_(kLongestMessage) {}

std::span<std::uint8_t> EventEncoder::body() {
  return std::span(message_).subspan(service::kBody);
}

std::span<const std::uint8_t> EventEncoder::detection_list(const RadarScan& scan, const SensorTime& time) {
  return finish(service::kEventDetectionList, write_detection_list(scan, time, body()), list_protector_);
}

std::span<const std::uint8_t> EventEncoder::ego_motion(const EgoMotion& ego, const SensorTime& time) {
  return finish(service::kEventEgoMotion, write_ego_motion(ego, time, body()), ego_protector_);
}

std::span<const std::uint8_t> EventEncoder::finish(std::uint16_t event, std::size_t body_bytes,
                                                   e2e::Protector& protector) {
  const std::span<std::uint8_t> message = std::span(message_).first(service::kBody + body_bytes);
  someip::ByteWriter header(message);
  header.u16(service::kServiceId);
  header.u16(event);
  header.u32(static_cast<std::uint32_t>(message.size() - 8));
  header.u16(0);
  header.u16(session_.take());
  header.u8(1);
  header.u8(service::kMajorVersion);
  header.u8(0x02);
  header.u8(0);
  // Cannot fail, as the message is never longer than profile 7 allows.
  static_cast<void>(protector.protect(message.subspan(service::kProtectedFrom)));
  return message;
}

}  // namespace boresight::replay
