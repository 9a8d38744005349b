// Ego signals as Toyota's CAN frames. Written from the public DBC file, independently of the gateway's decoder.
#pragma once

#include <array>
#include <cstdint>

#include "services/simulator/drive.hpp"

namespace boresight::simulator::wire {

struct CanFrame {
  std::uint32_t id;
  std::array<std::uint8_t, 8> bytes;
};

/// Yaw rate (0x024), steering angle (0x025), wheel speeds (0x0AA), in this order.
[[nodiscard]] std::array<CanFrame, 3> encode_ego(const EgoSignals& ego, double track_width_m = 1.55);

}  // namespace boresight::simulator::wire
