#include "services/boresight/input/drive_csv.hpp"

#include <cmath>

#include <fmt/format.h>

#include "services/boresight/input/flag_words.hpp"

namespace boresight::input {

namespace {

enum : std::size_t {
  kT,
  kRadar,
  kRange,
  kAz,
  kEl,
  kVr,
  kAzStd,
  kElStd,
  kVrStd,
  kVrMin,
  kVrMax,
  kRangeStd,
  kRcs,
  kSnr,
  kExistence,
  kValid,
  kAmbiguous,
  kFlags
};

constexpr double kPi = 3.1415926535897933, kFastest_mps = 500.0;
constexpr double kMostDecibel = 200.0;

constexpr Column optional_column(std::string_view name, double min, double max, std::string_view unit,
                                 std::string_view synonym = {}) {
  return {.name = name,
          .min = min,
          .max = max,
          .unit = unit,
          .required = false,
          .may_be_empty = true,
          .synonyms = {synonym}};
}

constexpr std::array<Column, 18> kDriveColumns = {{
    {.name = "t_s", .min = TimeOrder::kMin_s, .max = TimeOrder::kMax_s, .unit = "s", .synonyms = {"t", "time_s"}},
    {.name = "radar", .min = 1, .max = kMaxRadars, .unit = "(the radar's id)"},
    {.name = "range_m", .min = -100.0, .max = 1e5, .unit = "m", .synonyms = {"range"}},
    {.name = "azimuth_rad", .min = -kPi, .max = kPi, .unit = "rad", .synonyms = {"az"}},
    optional_column("elevation_rad", -kPi / 2, kPi / 2, "rad", "el"),
    {.name = "range_rate_mps", .min = -kFastest_mps, .max = kFastest_mps, .unit = "m/s", .synonyms = {"vr"}},
    optional_column("azimuth_std_rad", 0.0, kPi, "rad", "az_std"),
    optional_column("elevation_std_rad", 0.0, kPi, "rad", "el_std"),
    optional_column("range_rate_std_mps", 0.0, kFastest_mps, "m/s", "vr_std"),
    optional_column("range_rate_min_mps", -kFastest_mps, 0.0, "m/s", "vr_min"),
    optional_column("range_rate_max_mps", 0.0, kFastest_mps, "m/s", "vr_max"),
    optional_column("range_std_m", 0.0, 1e5, "m"),
    optional_column("rcs_dbsm", -kMostDecibel, kMostDecibel, "dBsm"),
    optional_column("snr_db", -kMostDecibel, kMostDecibel, "dB"),
    optional_column("existence", 0.0, 1.0, ""),
    optional_column("valid", 0.0, 1.0, ""),
    optional_column("ambiguous", 0.0, 1.0, ""),
    {.name = "flags", .min = 0.0, .max = 0.0, .unit = "", .required = false, .words = kFlagWords},
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
    row_ns_ = nanoseconds_of(table_.text(kT), row_[kT]);
    return true;
  }
  return false;
}

std::uint16_t DriveReader::flags_of_row() const {
  // An absent or empty cell is NaN, which compares as false: valid and not ambiguous.
  std::uint16_t flags = std::isnan(row_[kFlags]) ? std::uint16_t{0} : static_cast<std::uint16_t>(row_[kFlags]);
  if (row_[kValid] < 0.5) flags |= detection_flag::kInvalid;
  if (row_[kAmbiguous] >= 0.5) flags |= detection_flag::kAmbiguous;
  return flags;
}

bool DriveReader::next(RadarScan& scan, double& time_s) {
  if (!has_row_) return false;
  time_s = row_[kT];
  time_ns_ = row_ns_;
  const double radar = row_[kRadar];
  scan.header.source_id = static_cast<std::uint32_t>(radar);
  scan.dropped_detections = 0;
  scan.integrity = 0;
  scan.range_rate_min_mps = or_zero(row_[kVrMin]);
  scan.range_rate_max_mps = or_zero(row_[kVrMax]);
  const bool states_stds = table_.has(kAzStd) || table_.has(kElStd) || table_.has(kVrStd) || table_.has(kRangeStd);
  scan.fields = (states_stds ? scan_field::kStds : 0u) |
                (scan.range_rate_max_mps > scan.range_rate_min_mps ? scan_field::kAmbiguity : 0u);
  // Of these a scan has all values or none, because a detection cannot state that its own is missing.
  bool has_rcs = table_.has(kRcs), has_snr = table_.has(kSnr), has_existence = table_.has(kExistence);
  lacks_elevation_.reset();
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
    scan.rcs_dbsm[count] = or_zero(row_[kRcs]);
    scan.snr_db[count] = or_zero(row_[kSnr]);
    scan.range_std_m[count] = or_zero(row_[kRangeStd]);
    scan.azimuth_std_rad[count] = or_zero(row_[kAzStd]);
    scan.elevation_std_rad[count] = or_zero(row_[kElStd]);
    scan.range_rate_std_mps[count] = or_zero(row_[kVrStd]);
    scan.existence_probability[count] = std::isnan(row_[kExistence]) ? 1.0F : static_cast<float>(row_[kExistence]);
    has_rcs = has_rcs && !std::isnan(row_[kRcs]);
    has_snr = has_snr && !std::isnan(row_[kSnr]);
    has_existence = has_existence && !std::isnan(row_[kExistence]);
    scan.detection_flags[count] = flags_of_row();
    if (std::isnan(row_[kEl])) {
      lacks_elevation_.set(count);
    } else {
      scan.fields |= scan_field::kElevation;
    }
    ++count;
  } while ((has_row_ = read_row()) && row_[kT] == time_s && row_[kRadar] == radar);
  scan.number_of_valid_detections = static_cast<std::uint32_t>(count);
  scan.fields |= (has_rcs ? scan_field::kRcs : 0u) | (has_snr ? scan_field::kSnr : 0u) |
                 (has_existence ? scan_field::kExistence : 0u);
  // If some detections of a scan have an elevation, the others are unusable.
  if (scan.has(scan_field::kElevation) && lacks_elevation_.any()) {
    for (std::size_t i = 0; i < count; ++i) {
      if (lacks_elevation_[i]) scan.detection_flags[i] |= detection_flag::kUnusable;
    }
  }
  return true;
}

}  // namespace boresight::input
