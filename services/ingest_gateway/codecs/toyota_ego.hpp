// Toyota ego signals → EgoMotion: wheel speeds, yaw rate, steering angle.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "interfaces/messages/ego_motion.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/result.hpp"

namespace boresight::ingest {

/// Keeps the latest signals; each wheel-speed frame completes an ego motion. The speed is the mean of the rear wheels,
/// that is, of the rear axle's centre.
class ToyotaEgo {
 public:
  explicit ToyotaEgo(const EgoConfig& config) : config_(config) {}

  /// Takes one frame; kComplete when an ego motion is due.
  [[nodiscard]] DecodeResult take(std::uint32_t id, std::span<const std::uint8_t> payload, std::int64_t stamp_ns,
                                  std::string_view& problem);

  /// Writes all fields but the header. Signals older than 200 ms are left out of `fields`.
  void write(EgoMotion& out) const;

  [[nodiscard]] std::int64_t stamp_ns() const { return speed_stamp_ns_; }

 private:
  void take_speed(double speed_mps, std::int64_t stamp_ns);
  EgoConfig config_;
  double speed_mps_ = 0.0, yaw_rate_radps_ = 0.0, steering_angle_rad_ = 0.0, acceleration_mps2_ = 0.0;
  std::int64_t speed_stamp_ns_ = -1, yaw_rate_stamp_ns_ = -1, steering_stamp_ns_ = -1;
};

}  // namespace boresight::ingest
