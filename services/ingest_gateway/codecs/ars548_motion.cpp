#include "services/ingest_gateway/codecs/ars548_motion.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/wire/ars548.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/someip/big_endian.hpp"

namespace boresight::ingest::ars548 {

namespace layout = wire::ars548;

namespace {

// Ranges that the sensor accepts, as in the open-source driver nebula.
constexpr double kMaxAcceleration_mps2 = 65.0;
constexpr double kMaxSpeed_kmph = 350.0;
constexpr double kMaxYawRate_degps = 163.83;
constexpr double kMaxSteeringAngle_deg = 90.0;

/// Writes the message's header; all other bytes are zero.
std::uint8_t* begin(const layout::MotionInput& input, MotionDatagram& out) {
  out.bytes.fill(0);
  out.size = input.bytes;
  boresight::write_u16(out.bytes.data(), layout::kServiceId);
  boresight::write_u16(out.bytes.data() + 2, input.method);
  boresight::write_u32(out.bytes.data() + 4, static_cast<std::uint32_t>(input.bytes - layout::kShortHeaderBytes));
  return out.bytes.data() + input.value;
}

}  // namespace

std::span<const MotionDatagram> MotionFeed::encode(const EgoMotion& ego, std::int64_t now_ns) {
  if (last_ns_ != kNever && now_ns >= last_ns_ && now_ns - last_ns_ < config_.period_ns) return {};
  std::size_t count = 0;
  const auto put = [&](const layout::MotionInput& input, double value, double limit) {
    if (!std::isfinite(value)) return;
    boresight::write_f32(begin(input, datagrams_[count++]), static_cast<float>(std::clamp(value, -limit, limit)));
  };
  if (ego.has(ego_field::kSpeed) && std::isfinite(ego.speed_mps)) {
    const double speed_mps = std::abs(static_cast<double>(ego.speed_mps));
    moving_ = speed_mps > (moving_ ? config_.standing_below_mps : config_.moving_above_mps);
    const bool backward = ego.has(ego_field::kReverse) && ego.speed_mps < 0.0F;
    put(layout::kSpeed_kmph, 3.6 * speed_mps, kMaxSpeed_kmph);
    *begin(layout::kDrivingDirection, datagrams_[count++]) = static_cast<std::uint8_t>(!moving_ ? 0 : backward ? 2 : 1);
    put(layout::kLongitudinalAcceleration_mps2, ego.longitudinal_acceleration_mps2, kMaxAcceleration_mps2);
  }
  if (ego.has(ego_field::kYawRate))
    put(layout::kYawRate_degps, ego.yaw_rate_radps * kDegreesPerRadian, kMaxYawRate_degps);
  if (ego.has(ego_field::kSteeringAngle) && config_.steering_ratio > 0.0) {
    put(layout::kSteeringAngle_deg, ego.steering_angle_rad * kDegreesPerRadian / config_.steering_ratio,
        kMaxSteeringAngle_deg);
  }
  if (count > 0) last_ns_ = now_ns;
  return std::span(datagrams_).first(count);
}

}  // namespace boresight::ingest::ars548
