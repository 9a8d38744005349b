// The files of a run folder that grow with the recording. Rows are gathered and handed over in complete ones.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "services/boresight/run/results.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::run {

enum class File : std::uint8_t {
  kScans,
  kDetections,
  kReflectors,
  kTracks,
  kRoadEdges,
  kCollisionWarnings,
  kAlignment,
  kHealth
};
inline constexpr std::array<std::string_view, 8> kFileNames = {
    "scans.csv",      "detections.csv",         "reflectors.csv", "tracks.csv",
    "road_edges.csv", "collision_warnings.csv", "alignment.csv",  "health.jsonl"};

class Writer {
 public:
  /// Appends text to a file.
  using Put = std::function<void(File, std::string_view text)>;

  /// The header lines are the first rows, unless the files have them already. `vehicle` has the radars' names for the
  /// sentences of health.jsonl.
  Writer(Put put, VehicleConfig vehicle, bool has_headers = false);

  void write(const ScanResult& result);
  void write(const EstimateResult& result);
  void write(const HealthResult& result);
  /// Hands over what has been gathered, scans.csv last: its rows say that a scan is whole in the other tables.
  void flush();

 private:
  [[nodiscard]] std::string& rows(File file) { return rows_[static_cast<std::size_t>(file)]; }
  void hand_over(std::size_t least_bytes);

  Put put_;
  VehicleConfig vehicle_;
  std::array<std::string, kFileNames.size()> rows_;
};

/// A line of health.jsonl, with line feed.
[[nodiscard]] std::string to_json_line(const HealthResult& result, const VehicleConfig& vehicle);

}  // namespace boresight::run
