#include "services/ingest_gateway/codecs/toyota_ego.hpp"

#include <cmath>
#include <cstdlib>

#include "interfaces/wire/toyota.hpp"

namespace boresight::ingest {

namespace layout = wire::toyota;

namespace {

constexpr double kRadiansPerDegree = M_PI / 180.0;
constexpr std::int64_t kMaxAge_ns = 200'000'000;
constexpr double kAccelerationFilter_s = 0.2;

}  // namespace

DecodeResult ToyotaEgo::take(std::uint32_t id, std::span<const std::uint8_t> payload, std::int64_t stamp_ns,
                             std::string_view& problem) {
  if (id != layout::kYawRateId && id != layout::kSteeringId && id != layout::kWheelSpeedsId) {
    return DecodeResult::kIgnored;
  }
  if (payload.size() != 8) {
    problem = "Toyota ego: frame is not 8 bytes long";
    return DecodeResult::kBadLength;
  }
  if (id != layout::kWheelSpeedsId && layout::checksum(id, payload) != payload.back()) {
    problem = "Toyota ego: checksum does not match";
    return DecodeResult::kBadValue;
  }
  if (id == layout::kYawRateId) {
    yaw_rate_radps_ = wire::extract(layout::kYawRate_degps, payload) * kRadiansPerDegree;
    yaw_rate_stamp_ns_ = stamp_ns;
    return DecodeResult::kAccepted;
  }
  if (id == layout::kSteeringId) {
    steering_angle_rad_ =
        (wire::extract(layout::kSteeringAngle_deg, payload) + wire::extract(layout::kSteeringFraction_deg, payload)) *
        kRadiansPerDegree;
    steering_stamp_ns_ = stamp_ns;
    return DecodeResult::kAccepted;
  }
  const double speed_kmph = 0.5 * (wire::extract(layout::kWheelRearRight_kmph, payload) +
                                   wire::extract(layout::kWheelRearLeft_kmph, payload));
  if (std::abs(speed_kmph) > 252.0) {
    problem = "Toyota ego: wheel speed beyond ±252 km/h";
    return DecodeResult::kBadValue;
  }
  take_speed(speed_kmph / 3.6, stamp_ns);
  return DecodeResult::kComplete;
}

void ToyotaEgo::take_speed(double speed_mps, std::int64_t stamp_ns) {
  const double elapsed_s = static_cast<double>(stamp_ns - speed_stamp_ns_) * 1e-9;
  if (speed_stamp_ns_ >= 0 && elapsed_s > 1e-4 && stamp_ns - speed_stamp_ns_ < kMaxAge_ns) {
    const double gain = elapsed_s / (elapsed_s + kAccelerationFilter_s);
    acceleration_mps2_ += gain * ((speed_mps - speed_mps_) / elapsed_s - acceleration_mps2_);
  } else if (speed_stamp_ns_ < 0 || stamp_ns - speed_stamp_ns_ >= kMaxAge_ns || elapsed_s < 0.0) {
    acceleration_mps2_ = 0.0;
  }
  speed_mps_ = speed_mps;
  speed_stamp_ns_ = stamp_ns;
}

void ToyotaEgo::write(EgoMotion& out) const {
  const auto is_fresh = [this](std::int64_t stamp_ns) {
    return stamp_ns >= 0 && std::abs(speed_stamp_ns_ - stamp_ns) <= kMaxAge_ns;
  };
  // These wheel speeds carry no direction of travel, so kReverse is not claimed.
  out.fields = ego_field::kSpeed;
  if (is_fresh(yaw_rate_stamp_ns_)) out.fields |= ego_field::kYawRate;
  if (is_fresh(steering_stamp_ns_)) out.fields |= ego_field::kSteeringAngle;
  out.speed_mps = static_cast<float>(speed_mps_);
  out.speed_std_mps = static_cast<float>(config_.speed_std_mps);
  out.yaw_rate_radps = static_cast<float>(yaw_rate_radps_);
  out.yaw_rate_std_radps = static_cast<float>(config_.yaw_rate_std_radps);
  out.steering_angle_rad = static_cast<float>(steering_angle_rad_);
  out.steering_angle_std_rad = static_cast<float>(config_.steering_angle_std_rad);
  out.longitudinal_acceleration_mps2 = static_cast<float>(acceleration_mps2_);
}

}  // namespace boresight::ingest
