// EgoMotion → the messages by which an ARS548 learns how the vehicle moves. Without them it reports kWithoutEgoMotion.
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
  std::int64_t period_ns = 20'000'000;  ///< no closer than this: the sensor wants 10 … 50 Hz
  // Two thresholds, so that the noise of wheel speeds at a traffic light is no driving.
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

  /// What is to be sent now: a datagram for each quantity that `ego.fields` says is known, is finite, and limited to
  /// the sensor's range; nothing if the last ones went out less than a period ago by `now_ns` (any clock; one that goes
  /// back starts anew). Valid until the next call. The speed is the one signalled, without k_v. Acceleration goes with
  /// the speed it is derived from. The direction of travel is in the sign of the speed if kReverse is set, else
  /// forward.
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
