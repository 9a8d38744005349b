#include "services/ingest_gateway/codecs/srr520.hpp"

#include <algorithm>

#include "services/common/e2e/crc.hpp"
#include "services/ingest_gateway/codecs/report.hpp"

namespace boresight::ingest {

namespace srr520_layout = wire::srr520;

namespace {

// Time-out within a list, which takes some 5 ms on the bus.
constexpr std::int64_t kSrr520Silence_ns = 50'000'000;

std::uint16_t read_u16(const std::uint8_t* p) {
  return static_cast<std::uint16_t>(p[0] << 8 | p[1]);
}
std::uint32_t read_u32(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(p[0]) << 24 | static_cast<std::uint32_t>(p[1]) << 16 |
         static_cast<std::uint32_t>(p[2]) << 8 | p[3];
}

const char* name(std::size_t list) {
  return srr520_layout::kLists[list].name.data();
}

unsigned number_of_entries(const srr520_layout::ListLayout& list, const std::uint8_t* header) {
  const std::uint8_t* const p = header + list.count_offset;
  return list.count_bytes == 2 ? read_u16(p) : *p;
}

}  // namespace

Srr520Detection decode_srr520_detection(std::span<const std::uint8_t, srr520_layout::kDetectionBytes> record) {
  Srr520Detection detection{};
  detection.range_m = wire::extract(srr520_layout::kRange_m, record);
  detection.azimuth_rad = wire::extract(srr520_layout::kAzimuth_rad, record);
  detection.range_rate_mps = wire::extract(srr520_layout::kRangeRate_mps, record);
  const bool has_rcs = wire::extract_raw(srr520_layout::kRcs_dbsm, record) != srr520_layout::kRcsUnavailable;
  detection.rcs_dbsm = has_rcs ? wire::extract(srr520_layout::kRcs_dbsm, record) : 0.0;
  detection.snr_db = wire::extract(srr520_layout::kSnr_db, record);
  for (std::size_t i = 0; i < srr520_layout::kHypotheses.size(); ++i) {
    const bool set = wire::extract_raw(srr520_layout::kHypotheses[i], record) != 0;
    detection.hypotheses = static_cast<std::uint8_t>(detection.hypotheses | static_cast<unsigned>(set) << i);
  }
  detection.valid = wire::extract_raw(srr520_layout::kAzimuth_rad, record) != srr520_layout::kAzimuthUnavailable &&
                    wire::extract_raw(srr520_layout::kRangeRate_mps, record) != srr520_layout::kRangeRateUnavailable;
  return detection;
}

void Srr520::take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) {
  if (frame.kind == recording::FrameKind::kUdp || frame.can_extended || frame.can_remote) return;
  tick(stamp.received_ns, output);
  if (frame.can_id == srr520_layout::kStatusId) return take_status(frame.payload, output);
  if (frame.can_id == srr520_layout::kClosingId) return take_closing(frame.payload, output);
  for (std::size_t i = 0; i < srr520_layout::kLists.size(); ++i) {
    if (frame.can_id == srr520_layout::kLists[i].header_id) return take_header(i, frame.payload, stamp, output);
    if (frame.can_id == srr520_layout::kLists[i].record_id) return take_records(i, frame.payload, stamp, output);
  }
}

void Srr520::take_status(std::span<const std::uint8_t> payload, DecoderOutput& output) {
  if (payload.size() != srr520_layout::kStatusBytes) {
    report(output, Fault::kWireLength, "SRR520 status frame of %zu bytes, must be %zu", payload.size(),
           srr520_layout::kStatusBytes);
    return;
  }
  const unsigned crc = read_u16(&payload[srr520_layout::status::kCrc]);
  const unsigned computed = e2e::crc16_ccitt_false(payload.first(srr520_layout::status::kCrc));
  if (crc != computed) {
    report(output, Fault::kWireValue, "SRR520 status frame: CRC %04x, computed %04x", crc, computed);
    return;
  }
  std::uint32_t conditions = 0;
  const auto judge = [&](std::size_t offset, unsigned bits, std::uint32_t condition) {
    if ((payload[offset] & bits) != 0) conditions |= condition;
  };
  judge(srr520_layout::status::kDefective, srr520_layout::status::kNow, source_condition::kDefective);
  judge(srr520_layout::status::kSupplyVoltage, srr520_layout::status::kNowOfTwo, source_condition::kSupply);
  judge(srr520_layout::status::kTemperature, srr520_layout::status::kNowOfTwo, source_condition::kTemperature);
  judge(srr520_layout::status::kDynamicsInvalid, srr520_layout::status::kNowSpeedOrDirection,
        source_condition::kWithoutEgoMotion);
  judge(srr520_layout::status::kYawRateInvalid, srr520_layout::status::kNowOfOne, source_condition::kWithoutEgoMotion);
  if (payload[srr520_layout::status::kSyncStatus] != srr520_layout::kSyncOk)
    conditions |= source_condition::kUnsynchronised;
  output.report_conditions(conditions);
}

void Srr520::tick(std::int64_t now_ns, DecoderOutput& output) {
  if (open_ != kNone && now_ns - last_ns_ > kSrr520Silence_ns) reject_unclosed(output);
}

void Srr520::reject_unclosed(DecoderOutput& output) {
  report(output, Fault::kWireLength,
         "SRR520 %s list rejected: closing frame is missing, %zu of %zu record frames received", name(open_),
         received_.count(), srr520_layout::kLists[open_].number_of_frames);
  rejected_ = open_;
  open_ = kNone;
}

void Srr520::take_header(std::size_t list, std::span<const std::uint8_t> payload, const FrameStamp& stamp,
                         DecoderOutput& output) {
  if (open_ != kNone) reject_unclosed(output);
  started_ = true;
  if (payload.size() != srr520_layout::kHeaderBytes) {
    report(output, Fault::kWireLength, "SRR520 %s list rejected: header of %zu bytes, must be %zu", name(list),
           payload.size(), srr520_layout::kHeaderBytes);
    rejected_ = list;
    return;
  }
  std::copy(payload.begin(), payload.end(), bytes_.begin());
  received_.reset();
  open_ = list;
  rejected_ = kNone;
  first_ = stamp;
  last_ns_ = stamp.received_ns;
}

void Srr520::take_records(std::size_t list, std::span<const std::uint8_t> payload, const FrameStamp& stamp,
                          DecoderOutput& output) {
  if (list != open_) {
    if (list == rejected_ || !started_) return;
    report(output, Fault::kWireLength, "SRR520 %s list rejected: its header frame %u is missing", name(list),
           srr520_layout::kLists[list].header_id);
    rejected_ = list;
    return;
  }
  const auto reject = [&] {
    rejected_ = open_;
    open_ = kNone;
  };
  if (payload.size() != srr520_layout::kRecordFrameBytes) {
    report(output, Fault::kWireLength, "SRR520 %s list rejected: record frame of %zu bytes, must be %zu", name(list),
           payload.size(), srr520_layout::kRecordFrameBytes);
    return reject();
  }
  const unsigned number = payload[srr520_layout::kFrameNumber];
  const unsigned sequence = payload[srr520_layout::kFrameSequence];
  if (number >= srr520_layout::kLists[list].number_of_frames) {
    report(output, Fault::kWireValue, "SRR520 %s list rejected: frame number %u, allowed 0 … %zu", name(list), number,
           srr520_layout::kLists[list].number_of_frames - 1);
    return reject();
  }
  if (sequence != bytes_[srr520_layout::header::kSequenceCounter]) {
    report(output, Fault::kWireValue, "SRR520 %s list rejected: sequence counter %u in record frame %u, header has %u",
           name(list), sequence, number, unsigned{bytes_[srr520_layout::header::kSequenceCounter]});
    return reject();
  }
  std::copy(payload.begin(), payload.end(),
            bytes_.begin() +
                static_cast<std::ptrdiff_t>(srr520_layout::kHeaderBytes + number * srr520_layout::kRecordFrameBytes));
  received_.set(number);
  last_ns_ = stamp.received_ns;
}

void Srr520::take_closing(std::span<const std::uint8_t> payload, DecoderOutput& output) {
  const bool readable =
      payload.size() == srr520_layout::kClosingBytes && payload[srr520_layout::closing::kListId] < kNone;
  if (!readable) {
    if (!started_) return;
    if (payload.size() != srr520_layout::kClosingBytes) {
      report(output, Fault::kWireLength, "SRR520 closing frame of %zu bytes, must be %zu", payload.size(),
             srr520_layout::kClosingBytes);
    } else {
      report(output, Fault::kWireValue, "SRR520 closing frame: list id %u, allowed 0 … %zu",
             unsigned{payload[srr520_layout::closing::kListId]}, kNone - 1);
    }
    if (open_ != kNone) reject_unclosed(output);
    return;
  }
  const std::size_t list = payload[srr520_layout::closing::kListId];
  if (list != open_) {
    if (open_ != kNone) reject_unclosed(output);
    if (list != rejected_ && started_) {
      report(output, Fault::kWireLength, "SRR520 %s list rejected: its header frame %u is missing", name(list),
             srr520_layout::kLists[list].header_id);
    }
    rejected_ = kNone;
    return;
  }
  if (is_sound(read_u16(&payload[srr520_layout::closing::kCrc]), output)) {
    if (list == srr520_layout::kObjectList) {
      publish_ego(output);
    } else {
      publish_detections(output);
    }
  }
  open_ = kNone;
}

std::span<const std::uint8_t> Srr520::collected() const {
  return {bytes_.data(), srr520_layout::kHeaderBytes +
                             srr520_layout::kLists[open_].number_of_frames * srr520_layout::kRecordFrameBytes};
}

bool Srr520::is_sound(std::uint16_t crc, DecoderOutput& output) const {
  const srr520_layout::ListLayout& list = srr520_layout::kLists[open_];
  if (received_.count() != list.number_of_frames) {
    std::size_t first = 0;
    while (received_[first]) ++first;
    report(output, Fault::kWireLength,
           "SRR520 %s list rejected: %zu of %zu record frames are missing, first number %zu", name(open_),
           list.number_of_frames - received_.count(), list.number_of_frames, first);
    return false;
  }
  const std::uint16_t computed = e2e::crc16_ccitt_false(collected());
  if (computed != crc) {
    report(output, Fault::kWireValue, "SRR520 %s list rejected: CRC %04x, computed %04x", name(open_), unsigned{crc},
           unsigned{computed});
    return false;
  }
  const unsigned entries = number_of_entries(list, bytes_.data());
  const std::size_t capacity = list.number_of_frames * list.entries_per_frame;
  if (entries > capacity) {
    report(output, Fault::kWireValue, "SRR520 %s list rejected: number of entries %u, allowed 0 … %zu", name(open_),
           entries, capacity);
    return false;
  }
  const unsigned sync = bytes_[srr520_layout::header::kSyncStatus];
  if (sync < srr520_layout::kSyncOk || sync > srr520_layout::kSyncMax) {
    report(output, Fault::kWireValue, "SRR520 %s list rejected: sync status %u, allowed 1 … 3", name(open_), sync);
    return false;
  }
  const std::uint32_t nanoseconds = read_u32(&bytes_[srr520_layout::header::kNanoseconds]);
  if (nanoseconds >= 1'000'000'000) {
    report(output, Fault::kWireValue, "SRR520 %s list rejected: nanoseconds of the stamp %u, allowed 0 … 999999999",
           name(open_), nanoseconds);
    return false;
  }
  return true;
}

SensorStamp Srr520::sensor_stamp() {
  // The clock since power-up wraps every 71 minutes; its differences are correct across the wrap.
  const std::uint32_t clock_us = read_u32(&bytes_[srr520_layout::header::kSensorClock_us]);
  sensor_time_us_ = sensor_clock_us_ ? sensor_time_us_ + static_cast<std::int32_t>(clock_us - *sensor_clock_us_)
                                     : std::int64_t{clock_us};
  sensor_clock_us_ = clock_us;
  if (bytes_[srr520_layout::header::kSyncStatus] != srr520_layout::kSyncOk) return {sensor_time_us_ * 1000, false};
  return {static_cast<std::int64_t>(read_u32(&bytes_[srr520_layout::header::kSeconds])) * 1'000'000'000 +
              read_u32(&bytes_[srr520_layout::header::kNanoseconds]),
          true};
}

void Srr520::publish_detections(DecoderOutput& output) {
  const SensorStamp measured = sensor_stamp();
  RadarScan* const message = output.begin_scan();
  if (message == nullptr) return;
  RadarScan& scan = *message;
  // The code of the range rate ends at ±15 m/s, but the ambiguity is 21 … 23 m/s. This number must therefore be the
  // period of the ambiguity, and the unambiguous interval is ± half of it.
  const double ambiguous_mps =
      read_u16(&bytes_[srr520_layout::header::kAmbiguousVelocity]) * srr520_layout::kSpeedFactor_mps +
      srr520_layout::kSpeedOffset_mps;
  const bool has_interval = ambiguous_mps > 0.0;
  const double limit_mps = has_interval ? 0.5 * ambiguous_mps : 0.0;
  const std::size_t count = number_of_entries(srr520_layout::kLists[open_], bytes_.data());
  scan.cycle_counter = read_u32(&bytes_[srr520_layout::header::kCycleCounter]);
  scan.number_of_valid_detections = static_cast<std::uint32_t>(count);
  scan.dropped_detections = 0;
  scan.integrity = 0;
  scan.fields = scan_field::kRcs | scan_field::kSnr | (has_interval ? scan_field::kAmbiguity : 0u);
  scan.range_rate_min_mps = static_cast<float>(-limit_mps);
  scan.range_rate_max_mps = static_cast<float>(limit_mps);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = srr520_layout::kHeaderBytes + i / 10 * srr520_layout::kRecordFrameBytes +
                           i % 10 * srr520_layout::kDetectionBytes;
    const Srr520Detection detection =
        decode_srr520_detection(std::span(bytes_).subspan(at).first<srr520_layout::kDetectionBytes>());
    scan.range_m[i] = static_cast<float>(detection.range_m);
    scan.azimuth_rad[i] = static_cast<float>(detection.azimuth_rad);
    scan.elevation_rad[i] = 0.0F;
    scan.range_rate_mps[i] = static_cast<float>(detection.range_rate_mps);
    scan.rcs_dbsm[i] = static_cast<float>(detection.rcs_dbsm);
    scan.snr_db[i] = static_cast<float>(detection.snr_db);
    scan.range_std_m[i] = scan.azimuth_std_rad[i] = 0.0F;
    scan.elevation_std_rad[i] = scan.range_rate_std_mps[i] = 0.0F;
    scan.existence_probability[i] = 1.0F;
    const bool ambiguous = has_interval && std::abs(detection.range_rate_mps) > limit_mps;
    scan.detection_flags[i] = static_cast<std::uint16_t>((detection.valid ? 0 : detection_flag::kUnusable) |
                                                         (ambiguous ? detection_flag::kAmbiguous : 0));
  }
  output.publish_scan(first_, measured, 32);
}

void Srr520::publish_ego(DecoderOutput& output) const {
  EgoReading reading;
  const std::uint16_t speed = read_u16(&bytes_[srr520_layout::header::kEgoSpeed]);
  const std::uint16_t yaw_rate = read_u16(&bytes_[srr520_layout::header::kEgoYawRate]);
  if (speed <= srr520_layout::kCodeMax) {
    reading.speed_mps = speed * srr520_layout::kSpeedFactor_mps + srr520_layout::kSpeedOffset_mps;
    reading.speed_is_signed = true;
  }
  if (yaw_rate <= srr520_layout::kCodeMax) {
    reading.yaw_rate_radps = yaw_rate * srr520_layout::kYawRateFactor_radps + srr520_layout::kYawRateOffset_radps;
  }
  output.take_ego(reading, first_);
}

}  // namespace boresight::ingest
