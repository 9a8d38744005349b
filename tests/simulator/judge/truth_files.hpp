// The tables of truth that `boresight simulate` writes beside a drive, read back. Columns: tests/simulator/README.md.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string_view>
#include <vector>

#include "tests/simulator/detection_truth.hpp"
#include "tests/simulator/judge/object.hpp"

namespace boresight::judge {

/// The tables' word: "ghost_type_1". Unlike name_of's words for people it is part of a file format.
[[nodiscard]] std::string_view table_word(Provenance provenance);

struct TrueScan {
  double t_s = 0.0;                                   ///< since the drive's beginning
  std::vector<simulator::DetectionTruth> detections;  ///< in the order of the list; provenance, object, bounces, mirror
};
/// By radar, in the order of time. Scans without any detection are not in the table.
using TrueScans = std::map<std::uint32_t, std::vector<TrueScan>>;

/// Reads truth_detections.csv; throws std::runtime_error with the line that cannot be understood.
[[nodiscard]] TrueScans read_true_scans(std::istream& table);

/// The bodies that are not parked.
class TrueObjects {
 public:
  TrueObjects() = default;
  /// Reads truth_objects.csv; throws std::runtime_error with the line that cannot be understood.
  explicit TrueObjects(std::istream& table);
  /// In the vehicle's frame at that time, on a straight line between the table's instants; those that the table has at
  /// both, and none where it has neither.
  [[nodiscard]] std::vector<Object> at(double t_s) const;

 private:
  std::map<double, std::vector<Object>> instants_;
};

}  // namespace boresight::judge
