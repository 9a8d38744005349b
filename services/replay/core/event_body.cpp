#include "services/replay/core/event_body.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/byte_writer.hpp"

namespace boresight::replay {

namespace wire_list = wire::boresight_service::detection_list;
namespace wire_ego = wire::boresight_service::ego_motion;

// Both masks of fields have the same bits, so that they are copied without conversion.
static_assert(wire_list::field::kElevation == scan_field::kElevation && wire_list::field::kRcs == scan_field::kRcs &&
              wire_list::field::kSnr == scan_field::kSnr && wire_list::field::kStds == scan_field::kStds &&
              wire_list::field::kExistence == scan_field::kExistence &&
              wire_list::field::kAmbiguity == scan_field::kAmbiguity);
static_assert(wire_ego::field::kSpeed == ego_field::kSpeed && wire_ego::field::kYawRate == ego_field::kYawRate &&
              wire_ego::field::kSteeringAngle == ego_field::kSteeringAngle &&
              wire_ego::field::kDirection == ego_field::kReverse);
static_assert(wire_list::kMaxDetections >= kMaxDetections);

namespace {

/// Also false for NaN.
bool within(float value, float min, float max) {
  return value >= min && value <= max;
}

void write_time(someip::ByteWriter& out, const SensorTime& time) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const bool fits = time.epoch_ns >= 0 && time.epoch_ns / kSecond_ns <= 0xFFFF'FFFF;
  out.u32(fits ? static_cast<std::uint32_t>(time.epoch_ns / kSecond_ns) : 0);
  out.u32(fits ? static_cast<std::uint32_t>(time.epoch_ns % kSecond_ns) : 0);
  out.u8(time.sync_status);
}

/// Writes the quantities of one record and notes if one of them was not allowed.
class RecordWriter {
 public:
  RecordWriter(someip::ByteWriter& out, std::uint32_t fields) : out_(out), fields_(fields) {}

  void stated(float value, float min, float max) {
    const bool allowed = within(value, min, max);
    if (!allowed) flags_ |= wire_list::flag::kInvalid;
    out_.f32(allowed ? value : 0.0F);
  }
  void stated_if(std::uint32_t field, float value, float min, float max, float otherwise = 0.0F) {
    if ((fields_ & field) != 0) {
      stated(value, min, max);
    } else {
      out_.f32(otherwise);
    }
  }
  void std_of(float value, float max) {
    out_.f32((fields_ & wire_list::field::kStds) != 0 && within(value, 0.0F, max) ? value : 0.0F);
  }
  void end(std::uint16_t flags) {
    if ((flags & detection_flag::kUnusable) != 0) flags_ |= wire_list::flag::kInvalid;
    if ((flags & detection_flag::kAmbiguous) != 0) flags_ |= wire_list::flag::kAmbiguous;
    if ((flags & detection_flag::kInvalid) != 0) flags_ |= wire_list::flag::kDoubted;
    out_.u16(flags_);
    out_.u16(0);
  }

 private:
  someip::ByteWriter& out_;
  std::uint32_t fields_;
  std::uint16_t flags_ = 0;
};

void write_record(someip::ByteWriter& out, const RadarScan& scan, std::uint32_t fields, std::size_t i) {
  namespace field = wire_list::field;
  namespace limit = wire_list::limit;
  RecordWriter record(out, fields);
  record.stated(scan.range_m[i], 0.0F, limit::kRange_m);
  record.stated(scan.azimuth_rad[i], -limit::kAzimuth_rad, limit::kAzimuth_rad);
  record.stated_if(field::kElevation, scan.elevation_rad[i], -limit::kElevation_rad, limit::kElevation_rad);
  record.stated(scan.range_rate_mps[i], -limit::kRangeRate_mps, limit::kRangeRate_mps);
  record.std_of(scan.range_std_m[i], limit::kRangeStd_m);
  record.std_of(scan.azimuth_std_rad[i], limit::kAngleStd_rad);
  record.std_of(scan.elevation_std_rad[i], limit::kAngleStd_rad);
  record.std_of(scan.range_rate_std_mps[i], limit::kRangeRateStd_mps);
  record.stated_if(field::kRcs, scan.rcs_dbsm[i], limit::kRcsMin_dbsm, limit::kRcsMax_dbsm);
  record.stated_if(field::kSnr, scan.snr_db[i], limit::kSnrMin_db, limit::kSnrMax_db);
  record.stated_if(field::kExistence, scan.existence_probability[i], 0.0F, 1.0F, 1.0F);
  record.end(scan.detection_flags[i]);
}

}  // namespace

std::size_t write_detection_list(const RadarScan& scan, const SensorTime& time, std::span<std::uint8_t> out) {
  constexpr std::uint32_t kAllFields = wire_list::field::kElevation | wire_list::field::kRcs | wire_list::field::kSnr |
                                       wire_list::field::kStds | wire_list::field::kExistence |
                                       wire_list::field::kAmbiguity;
  constexpr float kLimit = wire_list::limit::kRangeRate_mps;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  std::uint32_t fields = scan.fields & kAllFields;
  const bool has_interval =
      (fields & wire_list::field::kAmbiguity) != 0 && within(scan.range_rate_min_mps, -kLimit, kLimit) &&
      within(scan.range_rate_max_mps, -kLimit, kLimit) && scan.range_rate_min_mps < scan.range_rate_max_mps;
  if (!has_interval) fields &= ~wire_list::field::kAmbiguity;

  someip::ByteWriter writer(out);
  writer.u16(wire_list::kLayoutVersionValue);
  writer.u16(wire_list::kMinHeaderBytes);
  write_time(writer, time);
  writer.u8(0);
  writer.u16(static_cast<std::uint16_t>(std::min<std::uint32_t>(scan.dropped_detections, 0xFFFF)));
  writer.u32(scan.cycle_counter);
  writer.u32(fields);
  writer.f32(has_interval ? scan.range_rate_min_mps : 0.0F);
  writer.f32(has_interval ? scan.range_rate_max_mps : 0.0F);
  writer.u16(static_cast<std::uint16_t>(count));
  writer.u16(wire_list::kMinRecordBytes);
  for (std::size_t i = 0; i < count; ++i) write_record(writer, scan, fields, i);
  return writer.overflowed() ? 0 : writer.size();
}

std::size_t write_ego_motion(const EgoMotion& ego, const SensorTime& time, std::span<std::uint8_t> out) {
  namespace field = wire_ego::field;
  namespace limit = wire_ego::limit;
  std::uint32_t fields = 0;
  float speed_mps = 0.0F, yaw_rate_radps = 0.0F, steering_angle_rad = 0.0F;
  const bool direction_known = ego.has(ego_field::kSpeed | ego_field::kReverse);
  // Without a direction the absolute value is sent, whatever the sign of the source.
  const float speed = direction_known ? ego.speed_mps : std::abs(ego.speed_mps);
  if (ego.has(ego_field::kSpeed) && within(speed, -limit::kSpeed_mps, limit::kSpeed_mps)) {
    fields |= field::kSpeed | (direction_known ? field::kDirection : 0u);
    speed_mps = speed;
  }
  if (ego.has(ego_field::kYawRate) && within(ego.yaw_rate_radps, -limit::kYawRate_radps, limit::kYawRate_radps)) {
    fields |= field::kYawRate;
    yaw_rate_radps = ego.yaw_rate_radps;
  }
  if (ego.has(ego_field::kSteeringAngle) &&
      within(ego.steering_angle_rad, -limit::kSteeringAngle_rad, limit::kSteeringAngle_rad)) {
    fields |= field::kSteeringAngle;
    steering_angle_rad = ego.steering_angle_rad;
  }

  someip::ByteWriter writer(out);
  writer.u16(wire_ego::kLayoutVersionValue);
  writer.u16(wire_ego::kMinBodyBytes);
  write_time(writer, time);
  writer.zeros(3);
  writer.u32(fields);
  writer.f32(speed_mps);
  writer.f32(yaw_rate_radps);
  writer.f32(steering_angle_rad);
  return writer.overflowed() ? 0 : writer.size();
}

}  // namespace boresight::replay
