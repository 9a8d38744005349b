// Frames to a Continental ARS408: what it shall send, and the ego motion it wants to know. Sent on request only.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/wire/ars408.hpp"

namespace boresight::ingest::ars408 {

struct CommandFrame {
  std::uint32_t can_id = 0;
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> bytes{};

  [[nodiscard]] std::span<const std::uint8_t> payload() const { return {bytes.data(), length}; }
};

enum class Output : std::uint8_t { kClusters, kObjects };

/// Tells the sensor to send clusters or objects, with quality and extended information, sorted by range, and to keep
/// that in its non-volatile memory. Write it once, not cyclically: the memory wears.
[[nodiscard]] CommandFrame configuration(Output output, unsigned sensor_id);

/// Speed with its direction, as signalled by the vehicle; beyond 163.82 m/s it is that. None if the speed is not known
/// or not a number. A speed whose direction is not known counts as forward.
[[nodiscard]] std::optional<CommandFrame> ego_speed(const EgoMotion& ego, unsigned sensor_id);

/// Yaw rate, + to the left, confined to ±327.67 °/s. None if it is not known or not a number.
[[nodiscard]] std::optional<CommandFrame> ego_yaw_rate(const EgoMotion& ego, unsigned sensor_id);

}  // namespace boresight::ingest::ars408
