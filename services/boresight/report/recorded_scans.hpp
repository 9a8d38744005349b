// The scans of a run folder (config/schema/run.md) with their detections, reflectors and confirmed tracks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/boresight/score/table.hpp"

namespace boresight::report {

/// A row of scans.csv.
struct ScanRow {
  std::uint32_t radar = 0;
  std::uint64_t scan = 0;
  std::int64_t time_ns = 0;
  std::size_t detections = 0, tracks = 0;
};

/// scans.csv alone. All members throw score::InputError.
class ScanRows {
 public:
  explicit ScanRows(const std::filesystem::path& folder);
  [[nodiscard]] bool next(ScanRow& row);
  /// Of the present row.
  void read(ClassifiedScan& scan) const;

 private:
  score::Table table_;
};

/// The four tables together. Rows of a scan that is not in scans.csv are passed over: a record that was cut off and
/// continued may hold such. All members throw score::InputError.
class RecordedScans {
 public:
  explicit RecordedScans(const std::filesystem::path& folder);
  /// The next scan and the confirmed tracks after it. Fields that the tables do not contain are 0.
  [[nodiscard]] bool next(ClassifiedScan& scan, TrackList& tracks);

 private:
  /// A table whose rows belong to scans, and whether it is at a row.
  struct Part {
    score::Table table;
    bool has_row;
    Part(const std::filesystem::path& file, const std::vector<std::string_view>& columns)
        : table(file, columns), has_row(table.next()) {}
  };
  /// Calls `read(i)` for each row of the scan. `stated` is the number of rows that scans.csv states.
  template <typename Read>
  void take(Part& part, const ScanRow& scan, std::optional<std::size_t> stated, const Read& read);

  ScanRows scans_;
  Part detections_, reflectors_, tracks_;
};

}  // namespace boresight::report
