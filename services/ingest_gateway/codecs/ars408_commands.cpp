#include "services/ingest_gateway/codecs/ars408_commands.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace boresight::ingest::ars408 {

namespace ars408_layout = wire::ars408;

namespace {

std::uint32_t id_of(std::uint32_t id, unsigned sensor_id) {
  return id + (sensor_id & ars408_layout::kMaxSensorId) * ars408_layout::kIdStep;
}

/// Code of a physical value, limited to the range of the signal.
std::uint16_t code_of(const wire::CanSignal& signal, double value) {
  const double code = std::round((value - signal.offset) / signal.factor);
  return static_cast<std::uint16_t>(std::clamp(code, 0.0, std::exp2(signal.length) - 1.0));
}

CommandFrame ego_frame(std::uint32_t id, unsigned sensor_id, unsigned code) {
  CommandFrame frame{id_of(id, sensor_id), ars408_layout::kEgoBytes, {}};
  frame.bytes[0] = static_cast<std::uint8_t>(code >> 8);
  frame.bytes[1] = static_cast<std::uint8_t>(code & 0xFFu);
  return frame;
}

}  // namespace

CommandFrame configuration(Output output, unsigned sensor_id) {
  CommandFrame frame{id_of(ars408_layout::kConfigurationId, sensor_id), ars408_layout::kConfigurationBytes, {}};
  frame.bytes = {0xF8, 0x00, 0x00, 0x00, 0x10, 0x9C, 0x00, 0x00};
  if (output == Output::kObjects) frame.bytes[4] = 0x08;
  return frame;
}

std::optional<CommandFrame> ego_speed(const EgoMotion& ego, unsigned sensor_id) {
  if (!ego.has(ego_field::kSpeed) || !std::isfinite(ego.speed_mps)) return std::nullopt;
  const unsigned code = code_of(ars408_layout::ego::kSpeed_mps, std::abs(static_cast<double>(ego.speed_mps)));
  const bool backward = ego.has(ego_field::kReverse) && ego.speed_mps < 0.0F;
  const unsigned moving = backward ? ars408_layout::ego::kBackward : ars408_layout::ego::kForward;
  return ego_frame(ars408_layout::kEgoSpeedId, sensor_id,
                   (code == 0 ? ars408_layout::ego::kStandstill : moving) << 14 | code);
}

std::optional<CommandFrame> ego_yaw_rate(const EgoMotion& ego, unsigned sensor_id) {
  if (!ego.has(ego_field::kYawRate) || !std::isfinite(ego.yaw_rate_radps)) return std::nullopt;
  const double degps = static_cast<double>(ego.yaw_rate_radps) * 180.0 / std::numbers::pi;
  return ego_frame(ars408_layout::kEgoYawRateId, sensor_id, code_of(ars408_layout::ego::kYawRate_degps, degps));
}

}  // namespace boresight::ingest::ars408
