// Frames to a Continental ARS408: configuration of its output, and the ego motion. Sent on request only.
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

/// Configures the sensor to send clusters or objects, with quality and extended information, sorted by range. The
/// sensor stores this in non-volatile memory with a limited number of writes: send it once, not cyclically.
[[nodiscard]] CommandFrame configuration(Output output, unsigned sensor_id);

/// Speed with its direction, as signalled by the vehicle, at most 163.82 m/s. None if the speed is unknown or NaN. A
/// speed with unknown direction is sent as forward.
[[nodiscard]] std::optional<CommandFrame> ego_speed(const EgoMotion& ego, unsigned sensor_id);

/// Yaw rate, + to the left, limited to ±327.67 °/s. None if unknown or NaN.
[[nodiscard]] std::optional<CommandFrame> ego_yaw_rate(const EgoMotion& ego, unsigned sensor_id);

}  // namespace boresight::ingest::ars408
