// A scan: all detections of one measurement cycle of one radar, in the sensor's own frame, as reported by the sensor.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

/// Bits of `RadarScan::fields`: the quantities that this sensor measures. A column whose bit is clear holds zeros
/// without meaning.
namespace scan_field {
inline constexpr std::uint32_t kElevation = 1u << 0;
inline constexpr std::uint32_t kRcs = 1u << 1;
inline constexpr std::uint32_t kSnr = 1u << 2;
inline constexpr std::uint32_t kStds = 1u << 3;       ///< standard deviations by the sensor; else the configured ones
inline constexpr std::uint32_t kExistence = 1u << 4;  ///< otherwise existence is 1
inline constexpr std::uint32_t kAmbiguity = 1u << 5;  ///< range_rate_min/max_mps bound the unambiguous interval
}  // namespace scan_field

/// Bits of `RadarScan::detection_flags`, per detection.
namespace detection_flag {
inline constexpr std::uint16_t kInvalid = 1u << 0;    ///< the sensor calls the detection invalid: evidence against it
inline constexpr std::uint16_t kAmbiguous = 1u << 1;  ///< the range rate lies outside the unambiguous interval
/// A needed value is not finite, beyond the protocol's limits, or not to be used by the protocol's word.
inline constexpr std::uint16_t kUnusable = 1u << 2;
/// For users that need no doubtful detections: any of the bits of doubt about more than the range rate.
inline constexpr std::uint16_t kUntrusted = kInvalid | kUnusable;
}  // namespace detection_flag

/// Bits of `RadarScan::integrity`: faults of the scan as a whole that the gateway detected.
namespace scan_integrity {
inline constexpr std::uint16_t kCounterGap = 1u << 0;   ///< scans are missing before this one
inline constexpr std::uint16_t kRepeated = 1u << 1;     ///< a list received before, by counter or by content and stamp
inline constexpr std::uint16_t kFrozen = 1u << 2;       ///< bitwise the same detections as in the previous scan
inline constexpr std::uint16_t kStale = 1u << 3;        ///< too old at reception, or the stamps do not advance
inline constexpr std::uint16_t kImplausible = 1u << 4;  ///< too many detections beyond the sensor's limits
inline constexpr std::uint16_t kContradictsEgo = 1u << 5;    ///< range rates contradict the vehicle's motion
inline constexpr std::uint16_t kIncomplete = 1u << 6;        ///< frames of the cycle are missing
inline constexpr std::uint16_t kImpossibleCopies = 1u << 7;  ///< many detections of the scan are copies of one another
inline constexpr std::size_t kNumberOfBits = 8;
}  // namespace scan_integrity

/// Detections of one radar cycle in the sensor frame (x along boresight, y left, z up). The first
/// `number_of_valid_detections` entries of each column are valid; the others are undefined.
struct RadarScan {
  static constexpr std::uint32_t kVersion = 2;

  MessageHeader header;
  std::uint32_t cycle_counter;  ///< the sensor's own counter, or the gateway's if it has none
  std::uint32_t number_of_valid_detections;
  std::uint16_t dropped_detections;  ///< detections beyond kMaxDetections
  std::uint16_t integrity;           ///< scan_integrity bits
  std::uint32_t fields;              ///< scan_field bits
  float range_rate_min_mps;          ///< unambiguous interval; both 0 if unknown
  float range_rate_max_mps;

  DetectionColumn<float> range_m;
  DetectionColumn<float> azimuth_rad;     ///< + left
  DetectionColumn<float> elevation_rad;   ///< + up; 0 if the sensor measures none
  DetectionColumn<float> range_rate_mps;  ///< d(range)/dt, + receding
  DetectionColumn<float> rcs_dbsm;
  DetectionColumn<float> snr_db;
  DetectionColumn<float> range_std_m;
  DetectionColumn<float> azimuth_std_rad;
  DetectionColumn<float> elevation_std_rad;
  DetectionColumn<float> range_rate_std_mps;
  DetectionColumn<float> existence_probability;  ///< 0…1
  DetectionColumn<std::uint16_t> detection_flags;

  [[nodiscard]] bool has(std::uint32_t field_bits) const { return (fields & field_bits) == field_bits; }
};

static_assert(kIsPlainMessage<RadarScan>);
static_assert(alignof(RadarScan) == 64);
static_assert(offsetof(RadarScan, range_m) == 128);
static_assert(sizeof(RadarScan) == 128 + 11 * 4096 + 2048);

}  // namespace boresight
