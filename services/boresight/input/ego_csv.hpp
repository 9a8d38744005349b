// Reads a table of the vehicle's motion.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "services/boresight/input/csv_table.hpp"
#include "services/boresight/input/time_order.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::input {

/// Columns of config/schema/tables.md.
class EgoReader {
 public:
  /// `config` has the stds of the signals. Throws TableError as CsvTable does. All arguments must outlive the reader.
  EgoReader(recording::ByteSource& source, const EgoConfig& config, Problems& problems);

  /// The next motion; `time_s` is the time of the table, the header is not written. False at the end.
  [[nodiscard]] bool next(EgoMotion& motion, double& time_s);
  /// Time of the motion that next() returned last, with every digit of the table.
  [[nodiscard]] std::int64_t time_ns() const { return time_ns_; }
  [[nodiscard]] const std::vector<std::string>& ignored_columns() const { return table_.ignored(); }

 private:
  EgoConfig config_;
  CsvTable table_;
  TimeOrder order_;
  std::int64_t time_ns_ = 0;
};

}  // namespace boresight::input
