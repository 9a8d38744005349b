#include "services/ingest_gateway/codecs/boresight_service.hpp"

#include <bit>
#include <cmath>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/big_endian.hpp"

namespace boresight::ingest::service {

namespace wire_format = wire::boresight_service;
namespace list = wire_format::detection_list;
namespace ego = wire_format::ego_motion;

namespace {

constexpr std::uint32_t kNanosecondsPerSecond = 1'000'000'000;

/// Also false for NaN.
bool is_within(float value, float min, float max) {
  return value >= min && value <= max;
}

/// A standard deviation, or 0 ("not stated") if it is not allowed.
float std_of(const std::uint8_t* p, float max) {
  const float value = read_f32(p);
  return is_within(value, 0.0F, max) ? value : 0.0F;
}

SensorStamp stamp_of(std::uint32_t seconds, std::uint32_t nanoseconds, std::uint8_t sync_status) {
  return {static_cast<std::int64_t>(seconds) * kNanosecondsPerSecond + nanoseconds,
          sync_status == wire_format::sync_status::kSynchronised};
}

/// Values of a list's header for all records.
struct ListFields {
  bool elevation, rcs, snr, stds, existence;
};

void write_detection(const std::uint8_t* record, const ListFields& fields, std::size_t i, RadarScan& scan) {
  namespace r = list::record;
  namespace limit = list::limit;
  const float range = read_f32(record + r::kRange_m);
  const float azimuth = read_f32(record + r::kAzimuth_rad);
  const float range_rate = read_f32(record + r::kRangeRate_mps);
  const float elevation = fields.elevation ? read_f32(record + r::kElevation_rad) : 0.0F;
  const float rcs = fields.rcs ? read_f32(record + r::kRcs_dbsm) : 0.0F;
  const float snr = fields.snr ? read_f32(record + r::kSnr_db) : 0.0F;
  const float existence = fields.existence ? read_f32(record + r::kExistenceProbability) : 1.0F;
  const bool sound =
      is_within(range, 0.0F, limit::kRange_m) && is_within(azimuth, -limit::kAzimuth_rad, limit::kAzimuth_rad) &&
      is_within(range_rate, -limit::kRangeRate_mps, limit::kRangeRate_mps) &&
      is_within(elevation, -limit::kElevation_rad, limit::kElevation_rad) &&
      (!fields.rcs || is_within(rcs, limit::kRcsMin_dbsm, limit::kRcsMax_dbsm)) &&
      (!fields.snr || is_within(snr, limit::kSnrMin_db, limit::kSnrMax_db)) && is_within(existence, 0.0F, 1.0F);
  const std::uint16_t flags = read_u16(record + r::kFlags);
  std::uint16_t out = 0;
  if (!sound || (flags & list::flag::kInvalid) != 0) out |= detection_flag::kUnusable;
  if ((flags & list::flag::kDoubted) != 0) out |= detection_flag::kInvalid;
  const bool outside = scan.range_rate_min_mps < scan.range_rate_max_mps &&
                       !is_within(range_rate, scan.range_rate_min_mps, scan.range_rate_max_mps);
  if (outside || (flags & list::flag::kAmbiguous) != 0) out |= detection_flag::kAmbiguous;
  scan.range_m[i] = range;
  scan.azimuth_rad[i] = azimuth;
  scan.elevation_rad[i] = elevation;
  scan.range_rate_mps[i] = range_rate;
  scan.rcs_dbsm[i] = rcs;
  scan.snr_db[i] = snr;
  scan.range_std_m[i] = fields.stds ? std_of(record + r::kRangeStd_m, limit::kRangeStd_m) : 0.0F;
  scan.azimuth_std_rad[i] = fields.stds ? std_of(record + r::kAzimuthStd_rad, limit::kAngleStd_rad) : 0.0F;
  scan.elevation_std_rad[i] =
      fields.stds && fields.elevation ? std_of(record + r::kElevationStd_rad, limit::kAngleStd_rad) : 0.0F;
  scan.range_rate_std_mps[i] = fields.stds ? std_of(record + r::kRangeRateStd_mps, limit::kRangeRateStd_mps) : 0.0F;
  scan.existence_probability[i] = existence;
  scan.detection_flags[i] = out;
}

}  // namespace

DecodeResult check_detections(std::span<const std::uint8_t> body, std::string_view& problem) {
  if (body.size() < list::kMinHeaderBytes) {
    problem = "detection list: body shorter than its 36-byte header";
    return DecodeResult::kBadLength;
  }
  const std::uint8_t* const p = body.data();
  if (read_u16(p + list::kLayoutVersion) != list::kLayoutVersionValue) {
    problem = "detection list: layout version is not 1";
    return DecodeResult::kBadValue;
  }
  const std::size_t header_bytes = read_u16(p + list::kHeaderBytes);
  const std::size_t record_bytes = read_u16(p + list::kRecordBytes);
  const std::size_t count = read_u16(p + list::kNumberOfDetections);
  if (count > list::kMaxDetections) {
    problem = "detection list: number of detections over 1024";
    return DecodeResult::kBadValue;
  }
  if (header_bytes < list::kMinHeaderBytes || header_bytes % 4 != 0) {
    problem = "detection list: header bytes below 36 or not a multiple of 4";
    return DecodeResult::kBadValue;
  }
  if (record_bytes < list::kMinRecordBytes || record_bytes % 4 != 0) {
    problem = "detection list: record bytes below 48 or not a multiple of 4";
    return DecodeResult::kBadValue;
  }
  if (read_u32(p + list::kNanoseconds) >= kNanosecondsPerSecond) {
    problem = "detection list: nanoseconds not below 1e9";
    return DecodeResult::kBadValue;
  }
  if (body.size() != header_bytes + count * record_bytes) {
    problem = "detection list: body's length is not header bytes + number of detections × record bytes";
    return DecodeResult::kBadLength;
  }
  return DecodeResult::kComplete;
}

SensorStamp decode_detections(std::span<const std::uint8_t> body, RadarScan& scan) {
  const std::uint8_t* const p = body.data();
  const std::uint32_t bits = read_u32(p + list::kFields);
  const float rate_min = read_f32(p + list::kRangeRateMin_mps);
  const float rate_max = read_f32(p + list::kRangeRateMax_mps);
  const float max_rate = list::limit::kRangeRate_mps;
  const bool has_interval = (bits & list::field::kAmbiguity) != 0 && is_within(rate_min, -max_rate, max_rate) &&
                            is_within(rate_max, -max_rate, max_rate) && rate_min < rate_max;
  const ListFields fields{.elevation = (bits & list::field::kElevation) != 0,
                          .rcs = (bits & list::field::kRcs) != 0,
                          .snr = (bits & list::field::kSnr) != 0,
                          .stds = (bits & list::field::kStds) != 0,
                          .existence = (bits & list::field::kExistence) != 0};
  scan.cycle_counter = read_u32(p + list::kCycleCounter);
  scan.number_of_valid_detections = read_u16(p + list::kNumberOfDetections);
  scan.dropped_detections = read_u16(p + list::kDroppedDetections);
  scan.integrity = 0;
  scan.fields = (fields.elevation ? scan_field::kElevation : 0u) | (fields.rcs ? scan_field::kRcs : 0u) |
                (fields.snr ? scan_field::kSnr : 0u) | (fields.stds ? scan_field::kStds : 0u) |
                (fields.existence ? scan_field::kExistence : 0u) | (has_interval ? scan_field::kAmbiguity : 0u);
  scan.range_rate_min_mps = has_interval ? rate_min : 0.0F;
  scan.range_rate_max_mps = has_interval ? rate_max : 0.0F;
  const std::size_t record_bytes = read_u16(p + list::kRecordBytes);
  const std::uint8_t* record = p + read_u16(p + list::kHeaderBytes);
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i, record += record_bytes) {
    write_detection(record, fields, i, scan);
  }
  return stamp_of(read_u32(p + list::kSeconds), read_u32(p + list::kNanoseconds), p[list::kSyncStatus]);
}

DecodeResult decode_ego(std::span<const std::uint8_t> body, EgoReading& reading, SensorStamp& time,
                        std::string_view& problem) {
  if (body.size() < ego::kMinBodyBytes) {
    problem = "ego motion: body shorter than 32 bytes";
    return DecodeResult::kBadLength;
  }
  const std::uint8_t* const p = body.data();
  if (read_u16(p + ego::kLayoutVersion) != ego::kLayoutVersionValue) {
    problem = "ego motion: layout version is not 1";
    return DecodeResult::kBadValue;
  }
  if (read_u16(p + ego::kBodyBytes) != body.size() || body.size() % 4 != 0) {
    problem = "ego motion: body bytes differs from the body's length, or is not a multiple of 4";
    return DecodeResult::kBadLength;
  }
  if (read_u32(p + ego::kNanoseconds) >= kNanosecondsPerSecond) {
    problem = "ego motion: nanoseconds not below 1e9";
    return DecodeResult::kBadValue;
  }
  const std::uint32_t bits = read_u32(p + ego::kFields);
  const auto value_of = [&](std::uint32_t bit, std::size_t at, float min, float max) -> std::optional<double> {
    const float value = read_f32(p + at);
    if ((bits & bit) == 0 || !is_within(value, min, max)) return std::nullopt;
    return value;
  };
  reading = EgoReading{};
  const bool is_signed = (bits & ego::field::kDirection) != 0;
  reading.speed_mps =
      value_of(ego::field::kSpeed, ego::kSpeed_mps, is_signed ? -ego::limit::kSpeed_mps : 0.0F, ego::limit::kSpeed_mps);
  reading.speed_is_signed = is_signed && reading.speed_mps.has_value();
  reading.yaw_rate_radps =
      value_of(ego::field::kYawRate, ego::kYawRate_radps, -ego::limit::kYawRate_radps, ego::limit::kYawRate_radps);
  reading.steering_angle_rad = value_of(ego::field::kSteeringAngle, ego::kSteeringAngle_rad,
                                        -ego::limit::kSteeringAngle_rad, ego::limit::kSteeringAngle_rad);
  time = stamp_of(read_u32(p + ego::kSeconds), read_u32(p + ego::kNanoseconds), p[ego::kSyncStatus]);
  return DecodeResult::kComplete;
}

void DetectionList::take(const recording::Frame& body, const FrameStamp& stamp, DecoderOutput& output) {
  std::string_view problem;
  const DecodeResult result = check_detections(body.payload, problem);
  if (const auto fault = fault_of(result)) {
    output.fault(*fault, problem);
    return;
  }
  RadarScan* const scan = output.begin_scan();
  if (scan == nullptr) return;
  const SensorStamp time = decode_detections(body.payload, *scan);
  output.publish_scan(stamp, time, 32);
}

void EgoEvent::take(const recording::Frame& body, const FrameStamp& stamp, DecoderOutput& output) {
  std::string_view problem;
  EgoReading reading;
  SensorStamp time;
  const DecodeResult result = decode_ego(body.payload, reading, time, problem);
  if (const auto fault = fault_of(result)) {
    output.fault(*fault, problem);
    return;
  }
  const MeasurementTime measured = measurement_time(time.time_ns, time.synchronised, stamp, 0);
  output.take_ego(reading, {measured.time_ns, stamp.epoch_offset_ns, measured.source});
}

}  // namespace boresight::ingest::service
