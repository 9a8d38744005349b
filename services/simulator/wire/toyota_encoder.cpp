#include "services/simulator/wire/toyota_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/wire/byte_writer.hpp"

namespace boresight::simulator::wire {

namespace {

void put_checksum(CanFrame& frame) {
  std::uint32_t sum = (frame.id & 0xFFu) + (frame.id >> 8) + 8u;
  for (std::size_t i = 0; i < 7; ++i) sum += frame.bytes[i];
  frame.bytes[7] = static_cast<std::uint8_t>(sum);
}

std::uint32_t wheel(double speed_mps) {
  return static_cast<std::uint32_t>(std::clamp(std::lround((3.6 * speed_mps + 67.67) / 0.01), 0l, 32767l));
}

}  // namespace

std::array<CanFrame, 3> encode_ego(const EgoSignals& ego, double track_width_m) {
  CanFrame yaw{0x024, {}};
  const double yaw_degps = ego.yaw_rate_radps * kDegreesPerRadian;
  put_bits(yaw.bytes, 1, 10,
           static_cast<std::uint32_t>(std::clamp(std::lround((yaw_degps + 125.0) / 0.244), 0l, 1023l)));
  put_checksum(yaw);

  CanFrame steering{0x025, {}};
  const double angle_deg = ego.steering_angle_rad * kDegreesPerRadian;
  const long coarse = std::lround(angle_deg / 1.5);
  const long fine = std::clamp(std::lround((angle_deg - 1.5 * static_cast<double>(coarse)) / 0.1), -8l, 7l);
  put_bits(steering.bytes, 3, 12, static_cast<std::uint32_t>(coarse) & 0xFFFu);
  put_bits(steering.bytes, 39, 4, static_cast<std::uint32_t>(fine) & 0xFu);
  put_checksum(steering);

  CanFrame wheels{0x0AA, {}};
  const double difference = 0.5 * track_width_m * ego.yaw_rate_radps;  // wheel speeds: right is faster in a left bend
  const std::uint32_t right = wheel(ego.speed_mps + difference), left = wheel(ego.speed_mps - difference);
  put_bits(wheels.bytes, 6, 15, right);
  put_bits(wheels.bytes, 22, 15, left);
  put_bits(wheels.bytes, 38, 15, right);
  put_bits(wheels.bytes, 54, 15, left);
  return {yaw, steering, wheels};
}

}  // namespace boresight::simulator::wire
