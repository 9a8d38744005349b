#include "services/ingest_gateway/core/ego_assembler.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

// Shortest time for which a change of speed is judged. Frames queue, so that two speeds measured a period apart may
// arrive at the same time. A bump changes the wheel speed by 0.85 m/s in 11 ms in a recorded drive (comma2k19).
constexpr double kShortestPeriod_s = 0.05;

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

}  // namespace

bool EgoAssembler::is_fresh(std::int64_t stamp_ns, std::int64_t now_ns, std::int64_t max_age_ns) {
  return stamp_ns != kNever && std::abs(now_ns - stamp_ns) <= max_age_ns;
}

EgoAssembler::Result EgoAssembler::take(const EgoReading& reading, const FrameStamp& stamp) {
  Result result;
  const std::int64_t now_ns = stamp.received_ns;
  // Signals from before the jump would seem new for the duration of the jump.
  const std::int64_t newest_ns = std::max(
      {signalled_speed_.stamp_ns, yaw_rate_.stamp_ns, steering_angle_.stamp_ns, reverse_.stamp_ns, step_.stamp_ns});
  if (newest_ns != kNever && now_ns < newest_ns - limits_.max_age_ns) {
    forget();
    result.time_jumped = true;
  }
  if (reading.yaw_rate_radps) {
    if (std::abs(*reading.yaw_rate_radps) < limits_.yaw_rate_max_radps) {
      yaw_rate_ = {*reading.yaw_rate_radps, now_ns};
    } else {
      result.rejected = "yaw rate is not a number or 3 rad/s or more";
    }
  }
  if (reading.steering_angle_rad) {
    if (std::abs(*reading.steering_angle_rad) <= limits_.steering_angle_max_rad) {
      steering_angle_ = {*reading.steering_angle_rad, now_ns};
    } else {
      result.rejected = "steering wheel angle is not a number or beyond ±20 rad";
    }
  }
  if (reading.reverse) reverse_ = {*reading.reverse, now_ns};
  if (reading.speed_mps) {
    const std::string_view problem = check_speed(*reading.speed_mps, now_ns);
    if (problem.empty()) {
      accept_speed(*reading.speed_mps, reading.speed_is_signed, stamp);
      result.complete = true;
    } else {
      result.rejected = problem;
    }
  }
  return result;
}

bool EgoAssembler::agree(const Signal<double>& earlier, double speed_mps, std::int64_t stamp_ns) const {
  const double elapsed_s = std::max(seconds(stamp_ns - earlier.stamp_ns), kShortestPeriod_s);
  return std::abs(speed_mps - earlier.value) < limits_.acceleration_max_mps2 * elapsed_s;
}

std::string_view EgoAssembler::check_speed(double speed_mps, std::int64_t stamp_ns) {
  if (!(speed_mps >= limits_.speed_min_mps && speed_mps <= limits_.speed_max_mps)) {
    return "speed is not a number or beyond -30 … 100 m/s";
  }
  const std::int64_t last_ns = signalled_speed_.stamp_ns;
  if (last_ns != kNever && stamp_ns < last_ns) return "speed is older than the previous one";
  follows_a_step_ = false;
  if (!is_fresh(last_ns, stamp_ns, limits_.max_age_ns) || agree(signalled_speed_, speed_mps, stamp_ns)) {
    step_readings_ = 0;
    return {};
  }
  const bool continues =
      step_readings_ > 0 && is_fresh(step_.stamp_ns, stamp_ns, limits_.max_age_ns) && agree(step_, speed_mps, stamp_ns);
  step_readings_ = continues ? step_readings_ + 1 : 1;
  step_ = {speed_mps, stamp_ns};
  if (step_readings_ < limits_.readings_to_accept_a_step) return "speed changes by more than 30 m/s²";
  step_readings_ = 0;
  follows_a_step_ = true;
  return {};
}

void EgoAssembler::accept_speed(double speed_mps, bool is_signed, const FrameStamp& stamp) {
  const std::int64_t now_ns = stamp.received_ns;
  const Signal<double> before = speed_;
  const bool was_reverse = direction_ == Direction::kReverse;
  signalled_speed_ = speed_ = {speed_mps, now_ns};
  speed_source_ = stamp.source;
  direction_ = Direction::kUnknown;
  if (is_signed) {
    direction_ = speed_mps < 0.0 ? Direction::kReverse : Direction::kForward;
  } else if (is_fresh(reverse_.stamp_ns, now_ns, limits_.max_reverse_age_ns)) {
    direction_ = reverse_.value ? Direction::kReverse : Direction::kForward;
    speed_.value = reverse_.value ? -std::abs(speed_mps) : std::abs(speed_mps);
  }
  // The slope across a gap, a step or a change of sign by the gear is no acceleration.
  const bool turned = !is_signed && (direction_ == Direction::kReverse) != was_reverse;
  if (!is_fresh(before.stamp_ns, now_ns, limits_.max_age_ns) || follows_a_step_ || turned) {
    acceleration_mps2_ = 0.0;
    return;
  }
  const double elapsed_s = seconds(now_ns - before.stamp_ns);
  if (elapsed_s <= 1e-4) return;  // two speeds of one burst give no slope
  const double gain = elapsed_s / (elapsed_s + limits_.acceleration_filter_s);
  acceleration_mps2_ += gain * ((speed_.value - before.value) / elapsed_s - acceleration_mps2_);
}

void EgoAssembler::forget() {
  signalled_speed_ = speed_ = yaw_rate_ = steering_angle_ = step_ = {};
  reverse_ = {};
  direction_ = Direction::kUnknown;
  acceleration_mps2_ = 0.0;
  step_readings_ = 0;
}

void EgoAssembler::write(EgoMotion& out) const {
  const bool has_speed = speed_.stamp_ns != kNever;
  const bool has_yaw_rate = has_speed && is_fresh(yaw_rate_.stamp_ns, speed_.stamp_ns, limits_.max_age_ns);
  const bool has_steering = has_speed && is_fresh(steering_angle_.stamp_ns, speed_.stamp_ns, limits_.max_age_ns);
  out.fields = (has_speed ? ego_field::kSpeed : 0u) | (has_yaw_rate ? ego_field::kYawRate : 0u) |
               (has_steering ? ego_field::kSteeringAngle : 0u) |
               (direction_ != Direction::kUnknown ? ego_field::kReverse : 0u);
  out.speed_mps = static_cast<float>(speed_.value);
  out.speed_std_mps = static_cast<float>(config_.speed_std_mps);
  out.yaw_rate_radps = has_yaw_rate ? static_cast<float>(yaw_rate_.value) : 0.0F;
  out.yaw_rate_std_radps = static_cast<float>(config_.yaw_rate_std_radps);
  out.steering_angle_rad = has_steering ? static_cast<float>(steering_angle_.value) : 0.0F;
  out.steering_angle_std_rad = static_cast<float>(config_.steering_angle_std_rad);
  out.longitudinal_acceleration_mps2 = static_cast<float>(acceleration_mps2_);
}

}  // namespace boresight::ingest
