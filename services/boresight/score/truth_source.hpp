// The tables of a truth: which there are, and the clock that they count on. Format: config/schema/truth.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace boresight::score {

struct TruthSource {
  std::filesystem::path objects;     ///< truth_objects.csv or boxes.csv
  std::filesystem::path detections;  ///< truth_detections.csv or labels.csv
  std::filesystem::path sensors;     ///< truth_sensors.csv
  std::filesystem::path visibility;  ///< truth_visibility.csv
  std::filesystem::path drive;       ///< truth.csv
  bool objects_are_boxes = false;    ///< `objects` has the columns of boxes.csv
  bool detections_are_labels = false;
};

/// The tables in a folder, or a single table of objects. Absent tables are empty paths. Throws InputError if there is
/// none.
[[nodiscard]] TruthSource find_truth(const std::filesystem::path& where);

/// Time of the first row of the truth, on its own clock; nothing if its tables are empty.
[[nodiscard]] std::optional<double> first_time_s(const TruthSource& truth);

/// Time on the run's clock (ns since the epoch) of the truth's time 0. The truth may count on the clock of the
/// recording, from the recording's beginning, or from the beginning of a simulated drive. The clock is taken that
/// brings the first times of run and truth nearest to each other.
[[nodiscard]] std::int64_t truth_origin_ns(double truth_first_s, std::int64_t run_first_ns, double run_first_s);

}  // namespace boresight::score
