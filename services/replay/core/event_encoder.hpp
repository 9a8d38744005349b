// Encodes one instance's events as complete SOME/IP messages (interfaces/wire/boresight_service.md, 2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/common/e2e/protector.hpp"
#include "services/common/someip/session_counter.hpp"
#include "services/replay/core/event_body.hpp"

namespace boresight::replay {

/// Data IDs of an instance's events.
struct DataIds {
  std::uint32_t detection_list = 0;
  std::uint32_t ego_motion = 0;
};

class EventEncoder {
 public:
  explicit EventEncoder(const DataIds& data_ids);

  /// A complete protected message, valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> detection_list(const RadarScan& scan, const SensorTime& time);
  [[nodiscard]] std::span<const std::uint8_t> ego_motion(const EgoMotion& ego, const SensorTime& time);

 private:
  [[nodiscard]] std::span<const std::uint8_t> finish(std::uint16_t event, std::size_t body_bytes,
                                                     e2e::Protector& protector);
  [[nodiscard]] std::span<std::uint8_t> body();

  someip::SessionCounter session_;
  e2e::Protector list_protector_;
  e2e::Protector ego_protector_;
  std::vector<std::uint8_t> message_;
};

}  // namespace boresight::replay
