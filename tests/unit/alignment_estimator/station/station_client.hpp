// A station for the tests: builds requests and reads answers, by the offsets of the interface definition alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "interfaces/wire/calibration_service.hpp"
#include "services/common/someip/big_endian.hpp"

namespace boresight::alignment::station::test {

namespace service = wire::calibration_service;
using Bytes = std::vector<std::uint8_t>;

inline void put(Bytes& bytes, std::uint64_t value, int count) {
  for (int i = count - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline Bytes start_payload(std::uint32_t radar, const std::vector<std::int16_t>& tilts, std::uint16_t scans = 10) {
  Bytes payload;
  put(payload, 1, 2);
  put(payload, service::start::kMinHeaderBytes, 2);
  put(payload, radar, 4);
  put(payload, tilts.size(), 2);
  put(payload, scans, 2);
  put(payload, 0, 8);
  for (const std::int16_t tilt : tilts) put(payload, static_cast<std::uint16_t>(tilt), 2);
  return payload;
}
inline Bytes measure_payload(std::uint16_t index, std::int16_t tilt = service::measure::kAsAskedFor) {
  Bytes payload;
  put(payload, 1, 2);
  put(payload, index, 2);
  put(payload, static_cast<std::uint16_t>(tilt), 2);
  put(payload, 0, 2);
  return payload;
}
inline Bytes tilt_payload(std::uint16_t index) {
  Bytes payload;
  put(payload, 1, 2);
  put(payload, index, 2);
  return payload;
}
inline Bytes run_payload() {
  return {0, 1, 0, 0};
}

struct Header {
  std::uint16_t service = wire::calibration_service::kServiceId;
  std::uint16_t method = 0;
  std::uint16_t client = 0x17;
  std::uint16_t session = 1;
  std::uint8_t protocol_version = 1;
  std::uint8_t interface_version = 1;
  std::uint8_t type = 0x00;
  std::uint8_t return_code = 0;
};
inline Bytes message(const Header& header, const Bytes& payload) {
  Bytes bytes;
  put(bytes, header.service, 2);
  put(bytes, header.method, 2);
  put(bytes, 8 + payload.size(), 4);
  put(bytes, header.client, 2);
  put(bytes, header.session, 2);
  bytes.insert(bytes.end(), {header.protocol_version, header.interface_version, header.type, header.return_code});
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

/// A received answer or event; the getters read its payload.
struct Answer {
  Bytes bytes;
  [[nodiscard]] std::uint8_t type() const { return bytes.at(14); }
  [[nodiscard]] service::ReturnCode code() const { return static_cast<service::ReturnCode>(bytes.at(15)); }
  [[nodiscard]] std::size_t payload_bytes() const { return bytes.size() - 16; }
  [[nodiscard]] std::uint8_t u8(std::size_t at) const { return bytes.at(16 + at); }
  [[nodiscard]] std::uint16_t u16(std::size_t at) const { return read_u16(&bytes.at(16 + at)); }
  [[nodiscard]] std::int16_t i16(std::size_t at) const { return static_cast<std::int16_t>(u16(at)); }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const { return read_u32(&bytes.at(16 + at)); }
  [[nodiscard]] float f32(std::size_t at) const { return read_f32(&bytes.at(16 + at)); }

  // Fields of a verdict:
  [[nodiscard]] bool accepted() const { return u8(service::verdict::kAccepted) == 1; }
  [[nodiscard]] service::Refusal refusal() const {
    return static_cast<service::Refusal>(u8(service::verdict::kRefusal));
  }
  /// Fields of a state record, which begins at `record`: 0 in GetState and events, 4 in verdicts.
  [[nodiscard]] service::State state(std::size_t record) const {
    return static_cast<service::State>(u8(record + service::state::kState));
  }
  [[nodiscard]] service::Failure failure(std::size_t record) const {
    return static_cast<service::Failure>(u8(record + service::state::kFailure));
  }
};

}  // namespace boresight::alignment::station::test
