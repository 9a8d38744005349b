// Reads a table of detections and groups its rows into scans.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "interfaces/messages/radar_scan.hpp"
#include "services/boresight/input/csv_table.hpp"
#include "services/boresight/input/time_order.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::input {

/// Columns of config/schema/tables.md. The elevation may be absent or empty if the radar measures none. Other columns
/// are ignored, also the truth is_stationary.
class DriveReader {
 public:
  /// Throws TableError as CsvTable does. All arguments must outlive the reader.
  DriveReader(recording::ByteSource& source, const VehicleConfig& vehicle, Problems& problems);

  /// The next scan: consecutive rows of the same time and radar. `time_s` is the time of the table. Of the header only
  /// source_id is written. The caller must have zeroed `scan` once. False at the end.
  [[nodiscard]] bool next(RadarScan& scan, double& time_s);

  /// Ignored columns, without is_stationary.
  [[nodiscard]] std::vector<std::string> ignored_columns() const;
  /// Time of the scan that next() returned last, with every digit of the table.
  [[nodiscard]] std::int64_t time_ns() const { return time_ns_; }
  [[nodiscard]] std::uint64_t dropped_detections() const { return dropped_; }
  /// Number of rows by id of radars that the vehicle file does not contain; these rows count as bad lines as well.
  [[nodiscard]] const std::map<std::uint32_t, std::uint64_t>& unknown_radars() const { return unknown_; }

 private:
  static constexpr std::size_t kColumns = 18;
  /// Reads on to the next good row; false at the end.
  bool read_row();
  /// Flags of the detection in the last row, without those of its elevation.
  [[nodiscard]] std::uint16_t flags_of_row() const;

  const VehicleConfig& vehicle_;
  CsvTable table_;
  TimeOrder order_;
  std::array<double, kColumns> row_{};
  bool has_row_ = false;
  std::int64_t row_ns_ = 0, time_ns_ = 0;
  std::bitset<kMaxDetections> lacks_elevation_;  // by detection of the current scan
  std::uint64_t dropped_ = 0;
  std::map<std::uint32_t, std::uint64_t> unknown_;
};

}  // namespace boresight::input
