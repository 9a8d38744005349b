// EgoMotion → messages of the vehicle's motion to an ARS548. Without them the sensor reports kWithoutEgoMotion.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "interfaces/messages/ego_motion.hpp"

namespace boresight::ingest::ars548 {

struct MotionConfig {
  /// Angle of the steering wheel over that of the front axle; 0: unknown, and the steering angle is not sent.
  double steering_ratio = 15.0;
  std::int64_t period_ns = 20'000'000;  ///< shortest period: the sensor accepts 10 … 50 Hz
  // Two thresholds (hysteresis), so that noise of the wheel speeds at standstill does not appear as motion.
  double standing_below_mps = 0.1;
  double moving_above_mps = 0.3;
};

/// One UDP payload for port wire::ars548::kSensorPort of the sensor.
struct MotionDatagram {
  std::array<std::uint8_t, 40> bytes{};
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::uint8_t> payload() const { return {bytes.data(), size}; }
};

/// One sensor's feed.
class MotionFeed {
 public:
  explicit MotionFeed(const MotionConfig& config = {}) : config_(config) {}

  /// Datagrams to be sent now: one per quantity in `ego.fields` that is finite, limited to the sensor's range. None if
  /// the last ones were sent less than a period ago by `now_ns` (any clock; starts again if the clock goes back). Valid
  /// until the next call. The speed is the signalled one, without k_v. The acceleration is sent with the speed from
  /// which it is derived. The direction of travel is the sign of the speed if kReverse is set, otherwise forward.
  [[nodiscard]] std::span<const MotionDatagram> encode(const EgoMotion& ego, std::int64_t now_ns);

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  static constexpr std::size_t kMessages = 5;

  MotionConfig config_;
  std::int64_t last_ns_ = kNever;
  bool moving_ = false;
  std::array<MotionDatagram, kMessages> datagrams_{};
};

}  // namespace boresight::ingest::ars548
