#include "services/boresight/align/drive_csv.hpp"

#include <cmath>

#include <fmt/format.h>

namespace boresight::align {

namespace {

enum : std::size_t { kT, kRadar, kRange, kAz, kEl, kVr, kAzStd, kElStd, kVrStd, kVrMin, kVrMax };

constexpr double kPi = 3.1415926535897933, kFastest_mps = 500.0;
constexpr std::array<Column, 11> kDriveColumns = {{
    {.name = "t", .min = TimeOrder::kMin_s, .max = TimeOrder::kMax_s, .unit = "s"},
    {.name = "radar", .min = 1, .max = kMaxRadars, .unit = "(the radar's id)"},
    {.name = "range", .min = -100.0, .max = 1e5, .unit = "m"},
    {.name = "az", .min = -kPi, .max = kPi, .unit = "rad"},
    {.name = "el", .min = -kPi / 2, .max = kPi / 2, .unit = "rad", .required = false, .may_be_empty = true},
    {.name = "vr", .min = -kFastest_mps, .max = kFastest_mps, .unit = "m/s"},
    {.name = "az_std", .min = 0.0, .max = kPi, .unit = "rad", .required = false, .may_be_empty = true},
    {.name = "el_std", .min = 0.0, .max = kPi, .unit = "rad", .required = false, .may_be_empty = true},
    {.name = "vr_std", .min = 0.0, .max = kFastest_mps, .unit = "m/s", .required = false, .may_be_empty = true},
    {.name = "vr_min", .min = -kFastest_mps, .max = 0.0, .unit = "m/s", .required = false, .may_be_empty = true},
    {.name = "vr_max", .min = 0.0, .max = kFastest_mps, .unit = "m/s", .required = false, .may_be_empty = true},
}};

float or_zero(double value) {
  return std::isnan(value) ? 0.0F : static_cast<float>(value);
}

std::string ids(const VehicleConfig& vehicle) {
  std::string text;
  for (const RadarConfig& radar : vehicle.radars) text += (text.empty() ? "" : ", ") + std::to_string(radar.id);
  return text;
}

}  // namespace

DriveReader::DriveReader(recording::ByteSource& source, const VehicleConfig& vehicle, Problems& problems)
    : vehicle_(vehicle), table_(source, kDriveColumns, problems) {
  has_row_ = read_row();
}

std::vector<std::string> DriveReader::ignored_columns() const {
  std::vector<std::string> names = table_.ignored();
  std::erase(names, "\"is_stationary\"");
  return names;
}

bool DriveReader::read_row() {
  while (table_.next(row_)) {
    if (row_[kRadar] != std::floor(row_[kRadar])) {
      table_.reject(kRadar, fmt::format("read {}, allowed is a whole number 1 … {}", row_[kRadar], kMaxRadars));
      continue;
    }
    const auto id = static_cast<std::uint32_t>(row_[kRadar]);
    if (vehicle_.radar(id) == nullptr) {
      ++unknown_[id];
      table_.reject(kRadar, fmt::format("radar {} is not in the vehicle file, which has {}", id, ids(vehicle_)));
      continue;
    }
    const double newest_s = order_.newest_s();
    if (!order_.accept(row_[kT])) {
      table_.reject(kT,
                    fmt::format("read {} s after {} s; times may go back by at most {} s and forward by at most {} s",
                                row_[kT], newest_s, TimeOrder::kBack_s, TimeOrder::kForward_s));
      continue;
    }
    table_.accept();
    return true;
  }
  return false;
}

bool DriveReader::next(RadarScan& scan, double& time_s) {
  if (!has_row_) return false;
  time_s = row_[kT];
  const double radar = row_[kRadar];
  scan.header.source_id = static_cast<std::uint32_t>(radar);
  scan.dropped_detections = 0;
  scan.integrity = 0;
  scan.range_rate_min_mps = or_zero(row_[kVrMin]);
  scan.range_rate_max_mps = or_zero(row_[kVrMax]);
  const bool states_stds = table_.has(kAzStd) || table_.has(kElStd) || table_.has(kVrStd);
  scan.fields = (states_stds ? scan_field::kStds : 0u) |
                (scan.range_rate_max_mps > scan.range_rate_min_mps ? scan_field::kAmbiguity : 0u);
  std::size_t count = 0;
  do {
    if (count == kMaxDetections) {
      ++dropped_;
      if (scan.dropped_detections < 0xFFFF) ++scan.dropped_detections;
      continue;
    }
    scan.range_m[count] = static_cast<float>(row_[kRange]);
    scan.azimuth_rad[count] = static_cast<float>(row_[kAz]);
    scan.elevation_rad[count] = or_zero(row_[kEl]);
    scan.range_rate_mps[count] = static_cast<float>(row_[kVr]);
    scan.azimuth_std_rad[count] = or_zero(row_[kAzStd]);
    scan.elevation_std_rad[count] = or_zero(row_[kElStd]);
    scan.range_rate_std_mps[count] = or_zero(row_[kVrStd]);
    scan.existence_probability[count] = 1.0F;
    // If some detections of a scan have an elevation, the others are invalid.
    const bool has_elevation = !std::isnan(row_[kEl]);
    scan.detection_flags[count] = has_elevation ? 0 : detection_flag::kInvalid;
    if (has_elevation) scan.fields |= scan_field::kElevation;
    ++count;
  } while ((has_row_ = read_row()) && row_[kT] == time_s && row_[kRadar] == radar);
  scan.number_of_valid_detections = static_cast<std::uint32_t>(count);
  if (!scan.has(scan_field::kElevation)) {
    for (std::size_t i = 0; i < count; ++i) scan.detection_flags[i] = 0;
  }
  return true;
}

}  // namespace boresight::align
