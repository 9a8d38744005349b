// run.json: what was run, what was lost, and how long it took.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/boresight/run/counts.hpp"
#include "services/boresight/run/gateway_feed.hpp"
#include "services/boresight/run/live_results.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::run {

/// Where inputs and settings came from.
struct Inputs {
  std::string version;
  std::vector<std::string> recordings;  ///< empty: tables
  std::string detections, ego;          ///< tables
  std::string vehicle_file;
  std::string configuration;                                        ///< folder
  std::vector<std::pair<std::string, std::string>> settings_files;  ///< service, file
};

/// Times of the whole run, s. Reading and decoding is what remains of the CPU time.
struct Timing {
  double wall_s = 0.0, cpu_s = 0.0, write_s = 0.0;
  StageTimes stages;
};

struct TableLosses {
  std::uint64_t lines = 0, bad_lines = 0;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> unknown_radars;  ///< id, lines
  std::uint64_t dropped_detections = 0;
};

struct Summary {
  Inputs inputs;
  bool is_complete = false;  ///< false: ended by a signal
  std::int64_t start_ns = 0;
  double recording_s = 0.0;
  Counts counts;
  std::array<SourceStatistics, kMaxRadars + 1> sources{};
  std::optional<recording::Counts> frames;  ///< of recordings
  std::optional<TableLosses> tables;
  std::array<Reasons, kMaxRadars + 1> rejected, noted;
  Timing timing;
};

/// What one who only listened to the running services knows of a drive.
struct LiveSummary {
  std::string version, vehicle_file, configuration;
  bool is_continued = false;         ///< the folder held an earlier part; counts are those of the last part
  std::int64_t epoch_offset_ns = 0;  ///< UNIX time minus the clock of the tables, when the record began
  const LiveResults& results;
};

/// The text of run.json of a live record.
[[nodiscard]] std::string to_json(const LiveSummary& summary, const VehicleConfig& vehicle);
/// The text of run.json with the time 0 of the drive's truth on the clock of the tables, which a listener does not
/// know. Throws std::invalid_argument if it is no JSON object.
[[nodiscard]] std::string with_truth_begin(std::string_view run_json, std::int64_t truth_begin_ns);

/// The text of run.json. Everything but "timing" is the same in every run.
[[nodiscard]] std::string to_json(const Summary& summary, const VehicleConfig& vehicle);

}  // namespace boresight::run
