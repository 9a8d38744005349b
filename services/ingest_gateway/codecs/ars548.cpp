#include "services/ingest_gateway/codecs/ars548.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/wire/ars548.hpp"
#include "services/common/someip/big_endian.hpp"
#include "services/ingest_gateway/codecs/protection.hpp"

namespace boresight::ingest::ars548 {

namespace layout = wire::ars548;

namespace {

std::uint16_t flags_of(const std::uint8_t* record, std::uint8_t invalid, float rate_min, float rate_max) {
  constexpr std::uint8_t kNeeded =
      layout::invalid::kRange | layout::invalid::kAzimuth | layout::invalid::kElevation | layout::invalid::kRangeRate;
  const float range = read_f32(record + layout::record::kRange_m);
  const float azimuth = read_f32(record + layout::record::kAzimuth_rad);
  const float elevation = read_f32(record + layout::record::kElevation_rad);
  const float range_rate = read_f32(record + layout::record::kRangeRate_mps);
  std::uint16_t flags = 0;
  const bool finite =
      std::isfinite(range) && std::isfinite(azimuth) && std::isfinite(elevation) && std::isfinite(range_rate);
  constexpr float kPi = 3.14159274F;
  const bool plausible = finite && range >= 0.0F && range <= 1500.0F && std::abs(azimuth) <= kPi &&
                         std::abs(elevation) <= kPi / 2.0F && std::abs(range_rate) <= 150.0F;
  if ((invalid & kNeeded) != 0) flags |= detection_flag::kInvalid;
  if (!plausible) flags |= detection_flag::kUnusable;
  const bool has_interval = rate_min < rate_max;
  if (has_interval && finite && (range_rate < rate_min || range_rate > rate_max)) flags |= detection_flag::kAmbiguous;
  return flags;
}

/// Standard deviation of a quantity, or 0 ("not stated") if it is flagged or not finite.
float std_of(const std::uint8_t* p, bool invalid) {
  const float value = read_f32(p);
  return !invalid && std::isfinite(value) && value > 0.0F ? value : 0.0F;
}

void write_detection(const std::uint8_t* record, std::size_t i, float rate_min, float rate_max, RadarScan& scan) {
  namespace r = layout::record;
  const std::uint8_t invalid = record[r::kInvalidFlags];
  scan.range_m[i] = read_f32(record + r::kRange_m);
  scan.azimuth_rad[i] = read_f32(record + r::kAzimuth_rad);
  scan.elevation_rad[i] = read_f32(record + r::kElevation_rad);
  scan.range_rate_mps[i] = read_f32(record + r::kRangeRate_mps);
  scan.rcs_dbsm[i] = static_cast<float>(static_cast<std::int8_t>(record[r::kRcs_dbsm]));
  scan.snr_db[i] = 0.0F;
  scan.range_std_m[i] = std_of(record + r::kRangeStd_m, (invalid & layout::invalid::kRangeStd) != 0);
  scan.azimuth_std_rad[i] = std_of(record + r::kAzimuthStd_rad, (invalid & layout::invalid::kAzimuthStd) != 0);
  scan.elevation_std_rad[i] = std_of(record + r::kElevationStd_rad, (invalid & layout::invalid::kElevationStd) != 0);
  scan.range_rate_std_mps[i] = std_of(record + r::kRangeRateStd_mps, (invalid & layout::invalid::kRangeRateStd) != 0);
  scan.existence_probability[i] =
      std::min(1.0F, static_cast<float>(record[r::kPositivePredictiveValue_percent]) * 0.01F);
  scan.detection_flags[i] = flags_of(record, invalid, rate_min, rate_max);
}

}  // namespace

DecodeResult check(std::span<const std::uint8_t> datagram, std::string_view& problem) {
  if (datagram.size() < layout::kShortHeaderBytes) {
    problem = "ARS548: datagram shorter than its 8-byte header";
    return DecodeResult::kBadLength;
  }
  const std::uint8_t* const bytes = datagram.data();
  const std::uint16_t service = read_u16(bytes);
  const std::uint16_t method = read_u16(bytes + 2);
  if (service == layout::kServiceId && (method == layout::kMethodObjectList || method == layout::kMethodFilterStatus)) {
    return DecodeResult::kIgnored;
  }
  if (service == layout::kServiceId && method == layout::kMethodStatus) {
    if (datagram.size() == layout::kStatusBytes) return DecodeResult::kAccepted;
    problem = "ARS548: status is not 84 bytes long";
    return DecodeResult::kBadLength;
  }
  if (service != layout::kServiceId || method != layout::kMethodDetectionList) {
    problem = "ARS548: unknown service or method; known: service 0, methods 329, 336, 380, 396";
    return DecodeResult::kUnknownMessage;
  }
  if (datagram.size() != layout::kDetectionListBytes) {
    problem = "ARS548: detection list is not 35336 bytes long";
    return DecodeResult::kBadLength;
  }
  if (read_u32(bytes + 4) != datagram.size() - layout::kShortHeaderBytes) {
    problem = "ARS548: length field of the detection list is not 35328";
    return DecodeResult::kBadLength;
  }
  if (read_u32(bytes + layout::kNumberOfDetections) > layout::kMaxDetectionRecords) {
    problem = "ARS548: number of detections over 800";
    return DecodeResult::kBadValue;
  }
  if (read_u32(bytes + layout::kNanoseconds) >= 1'000'000'000) {
    problem = "ARS548: nanoseconds of the stamp not below 1e9";
    return DecodeResult::kBadValue;
  }
  return DecodeResult::kComplete;
}

SensorStamp decode(std::span<const std::uint8_t> datagram, RadarScan& scan) {
  const std::uint8_t* const bytes = datagram.data();
  const std::uint32_t count = read_u32(bytes + layout::kNumberOfDetections);
  const float rate_min = read_f32(bytes + layout::kRangeRateMin_mps);
  const float rate_max = read_f32(bytes + layout::kRangeRateMax_mps);
  const bool has_interval = std::isfinite(rate_min) && std::isfinite(rate_max) && rate_min < rate_max;
  scan.cycle_counter = read_u32(bytes + layout::kSequenceCounter);
  scan.integrity = 0;
  scan.number_of_valid_detections = count;
  scan.dropped_detections = 0;
  scan.fields = scan_field::kElevation | scan_field::kRcs | scan_field::kStds | scan_field::kExistence |
                (has_interval ? scan_field::kAmbiguity : 0u);
  scan.range_rate_min_mps = has_interval ? rate_min : 0.0F;
  scan.range_rate_max_mps = has_interval ? rate_max : 0.0F;
  for (std::size_t i = 0; i < count; ++i) {
    write_detection(bytes + layout::kDetections + i * layout::kDetectionBytes, i, scan.range_rate_min_mps,
                    scan.range_rate_max_mps, scan);
  }
  return stamp_of(datagram);
}

SensorStamp stamp_of(std::span<const std::uint8_t> list) {
  const std::uint8_t* const bytes = list.data();
  return {static_cast<std::int64_t>(read_u32(bytes + layout::kSeconds)) * 1'000'000'000 +
              read_u32(bytes + layout::kNanoseconds),
          bytes[layout::kSyncStatus] == layout::kSyncOk};
}

std::uint32_t conditions(std::span<const std::uint8_t> status) {
  namespace st = layout::status;
  const std::uint8_t* const bytes = status.data();
  std::uint32_t bits = 0;
  const std::uint8_t blockage = bytes[st::kBlockage] & 0x0F;
  const std::uint8_t self_test = bytes[st::kBlockage] >> 4;
  if (blockage <= st::kBlockageHigh) bits |= source_condition::kBlocked;
  if (blockage == st::kBlockageMid || blockage == st::kBlockageLow) bits |= source_condition::kPartlyBlocked;
  if (self_test == st::kSelfTestFailed || bytes[st::kRadarState] == st::kStateInvalid) {
    bits |= source_condition::kDefective;
  }
  if (bytes[st::kVoltage] != 0) bits |= source_condition::kSupply;
  if (bytes[st::kTemperature] != 0) bits |= source_condition::kTemperature;
  if (bytes[st::kSyncStatus] != layout::kSyncOk) bits |= source_condition::kUnsynchronised;
  if (bytes[st::kVelocityStatus] != 0 || bytes[st::kYawRateStatus] != 0) bits |= source_condition::kWithoutEgoMotion;
  return bits;
}

void Ars548::take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) {
  std::string_view problem;
  const DecodeResult result = check(frame.payload, problem);
  if (result == DecodeResult::kAccepted) output.report_conditions(conditions(frame.payload));
  if (const auto fault = fault_of(result)) output.fault(*fault, problem);
  if (result != DecodeResult::kComplete) return;
  if (e2e_required_) {
    constexpr std::size_t kRequestId = 8;  // begin of the protected data
    const e2e::Status status = check_protection(checker_, frame.payload.subspan(kRequestId), output);
    if (!e2e::is_acceptable(status)) {
      output.fault(Fault::kWireValue, e2e::describe(status));
      return;
    }
  }
  RadarScan* const scan = output.begin_scan();
  if (scan == nullptr) return;
  const SensorStamp time = decode(frame.payload, *scan);
  // Firmware that does not fill the E2E header always leaves it at zero.
  output.publish_scan(stamp, time, scan->cycle_counter == 0 ? 0 : 32);
}

}  // namespace boresight::ingest::ars548
