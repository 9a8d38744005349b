// Reads the tables of truth that `boresight simulate` writes beside a drive. Columns: services/simulator/README.md.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string_view>
#include <vector>

#include "services/simulator/detection_truth.hpp"
#include "services/simulator/judge/object.hpp"

namespace boresight::judge {

/// The word for a provenance in the tables, such as "ghost_type_1". It is part of a file format, unlike name_of().
[[nodiscard]] std::string_view table_word(Provenance provenance);

struct TrueScan {
  double t_s = 0.0;                                   ///< since the beginning of the drive
  std::vector<simulator::DetectionTruth> detections;  ///< in the order of the list; provenance, object, bounces, mirror
};
/// Scans by radar, in the order of time. Scans without any detection are not in the table.
using TrueScans = std::map<std::uint32_t, std::vector<TrueScan>>;

/// Reads truth_detections.csv. Throws std::runtime_error with file and line if a line is not valid.
[[nodiscard]] TrueScans read_true_scans(std::istream& table);

/// The bodies that are not parked.
class TrueObjects {
 public:
  TrueObjects() = default;
  /// Reads truth_objects.csv. Throws std::runtime_error with file and line if a line is not valid.
  explicit TrueObjects(std::istream& table);
  /// Objects in the vehicle frame at that time, interpolated linearly between the two neighbouring instants of the
  /// table. Only objects present at both instants are returned. Outside the table, the first or last instant is
  /// returned.
  [[nodiscard]] std::vector<Object> at(double t_s) const;

 private:
  std::map<double, std::vector<Object>> instants_;
};

}  // namespace boresight::judge
