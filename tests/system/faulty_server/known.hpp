// Computes the detections of wire.py's lists again: delivered ones must be bitwise equal.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::faulty_server {

/// Variants of a list.
enum class Variant : std::uint8_t {
  kPlain = 0,
  kNotNumbers = 1,  ///< one bad number in each of the first 14 detections
  kNoInterval = 2,  ///< the unambiguous interval is NaN
};

struct KnownScan {
  std::uint32_t radar = 0, cycle = 0, count = 0;
  Variant variant = Variant::kPlain;
  friend bool operator==(const KnownScan&, const KnownScan&) = default;
};

/// In the order of the record: range, azimuth, elevation, range rate, their standard deviations, rcs, snr, existence.
using Record = std::array<float, 11>;
inline constexpr std::size_t kRange = 0, kAzimuth = 1, kElevation = 2, kRangeRate = 3, kFirstStd = 4, kRcs = 8,
                             kSnr = 9, kExistence = 10;
inline constexpr float kRateMin_mps = -50.0F, kRateMax_mps = 50.0F;

[[nodiscard]] inline std::uint32_t mixed(const KnownScan& known, std::uint32_t i) {
  return known.cycle * 2654435761u + known.radar * 40503u + i * 7919u;
}

/// As scaled integers, so that every value is exact.
[[nodiscard]] inline Record record_of(const KnownScan& known, std::uint32_t i) {
  const std::uint32_t h = mixed(known, i);
  const auto field = [h](unsigned shift, unsigned bits, int centre, float scale) {
    return static_cast<float>(static_cast<int>(h >> shift & ((1u << bits) - 1)) - centre) / scale;
  };
  return {field(0, 16, 0, 64.0F),     field(4, 12, 2048, 2048.0F), field(8, 10, 512, 2048.0F),
          field(12, 12, 2048, 32.0F), field(1, 8, 0, 64.0F),       field(3, 8, 0, 8192.0F),
          field(5, 8, 0, 8192.0F),    field(7, 8, 0, 64.0F),       field(9, 12, 2048, 32.0F),
          field(11, 12, 0, 32.0F),    field(2, 8, 0, 256.0F)};
}

/// Effect of wire.py's BAD_NUMBERS: quantities are unchanged, invalid standard deviations are not stated. True: marked
/// invalid.
inline bool spoil(std::uint32_t i, Record& record) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  switch (i) {
    case 0:
      record[kRange] = kNan;
      return true;
    case 1:
      record[kAzimuth] = kInf;
      return true;
    case 2:
      record[kRangeRate] = -kInf;
      return true;
    case 3:
      record[kElevation] = kNan;
      return true;
    case 4:
      record[kRcs] = kNan;
      return true;
    case 5:
      record[kSnr] = kInf;
      return true;
    case 6:
      record[kExistence] = kNan;
      return true;
    case 7:
      record[kExistence] = 1.5F;
      return true;
    case 8:
      record[kRange] = -1.0F;
      return true;
    case 9:
      record[kAzimuth] = 3.5F;
      return true;
    case 10:
    case 11:
    case 12:
    case 13:
      record[kFirstStd + i - 10] = 0.0F;
      return false;
    default:
      return false;
  }
}

/// The first difference; "" if there is none. Integrity bits and header are not compared.
[[nodiscard]] inline std::string difference(const RadarScan& scan, const KnownScan& known) {
  const bool has_interval = known.variant != Variant::kNoInterval;
  if (scan.cycle_counter != known.cycle) return "cycle " + std::to_string(scan.cycle_counter);
  if (scan.number_of_valid_detections != known.count)
    return std::to_string(scan.number_of_valid_detections) + " detections";
  if (scan.dropped_detections != 0) return "dropped detections";
  if (scan.fields != (has_interval ? 0x3Fu : 0x1Fu)) return "fields";
  if (scan.range_rate_min_mps != (has_interval ? kRateMin_mps : 0.0F)) return "range rate min";
  if (scan.range_rate_max_mps != (has_interval ? kRateMax_mps : 0.0F)) return "range rate max";
  for (std::uint32_t i = 0; i < known.count; ++i) {
    Record record = record_of(known, i);
    bool invalid = (mixed(known, i) >> 16 & 1) != 0;
    if (known.variant == Variant::kNotNumbers && spoil(i, record)) invalid = true;
    const bool inside = record[kRangeRate] >= kRateMin_mps && record[kRangeRate] <= kRateMax_mps;
    const int flags =
        (invalid ? detection_flag::kUnusable : 0) | (has_interval && !inside ? detection_flag::kAmbiguous : 0);
    const Record got = {
        scan.range_m[i],     scan.azimuth_rad[i],     scan.elevation_rad[i],        scan.range_rate_mps[i],
        scan.range_std_m[i], scan.azimuth_std_rad[i], scan.elevation_std_rad[i],    scan.range_rate_std_mps[i],
        scan.rcs_dbsm[i],    scan.snr_db[i],          scan.existence_probability[i]};
    for (std::size_t field = 0; field < got.size(); ++field) {
      if (std::bit_cast<std::uint32_t>(got[field]) != std::bit_cast<std::uint32_t>(record[field])) {
        return "detection " + std::to_string(i) + ", number " + std::to_string(field) + ": " +
               std::to_string(got[field]) + " instead of " + std::to_string(record[field]);
      }
    }
    if (scan.detection_flags[i] != flags) return "flags of detection " + std::to_string(i);
  }
  return "";
}

}  // namespace boresight::faulty_server
