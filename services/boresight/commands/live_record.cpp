#include "services/boresight/commands/live_record.hpp"

#include <chrono>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "services/boresight/run/rows.hpp"
#include "services/boresight/run/summary.hpp"
#include "services/boresight/score/table.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/clock.hpp"

namespace boresight {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSnapshotsFile = "monitor.jsonl";

/// The first measurement of a record that is in the folder; none if the folder holds no scan.
std::optional<std::int64_t> start_of_record(const fs::path& folder) {
  const fs::path file = folder / run::kFileNames.front();
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored) || fs::file_size(file, ignored) == 0) return std::nullopt;
  if (fmt::format("{}", fmt::join(score::header_of(file), ",")) != run::kScansHeader) {
    throw std::runtime_error(file.string() + ": has the columns of another version; give another folder");
  }
  score::Table table(file, {"t_s", "time_ns"});
  try {
    if (!table.next()) return std::nullopt;
  } catch (const score::InputError&) {  // the only row was cut off
    return std::nullopt;
  }
  constexpr double kMost_s = 1e9;
  constexpr std::int64_t kMost_ns = std::numeric_limits<std::int64_t>::max();
  return table.integer("time_ns", 0, kMost_ns) - std::llround(table.number("t_s", -kMost_s, kMost_s) * 1e9);
}

/// The monitor's clock begins again when the ECU does; rows after that would have times before the record.
void refuse_later_record(const fs::path& folder, std::int64_t start_ns) {
  const std::int64_t now_ns = runtime::monotonic_now_ns();
  if (start_ns <= now_ns) return;
  throw std::runtime_error(
      fmt::format("{}: its record begins at {:.3f} s of CLOCK_MONOTONIC, later than now, {:.3f} s: the ECU was "
                  "restarted; give another folder",
                  folder.string(), static_cast<double>(start_ns) * 1e-9, static_cast<double>(now_ns) * 1e-9));
}

/// Rows of this version do not fit under the header of another one.
void refuse_other_columns(const fs::path& folder) {
  const fs::path file = folder / "alignment.csv";
  std::ifstream stream(file);
  std::string header;
  if (!std::getline(stream, header) || header == run::kAlignmentHeader) return;
  throw std::runtime_error(
      fmt::format("{}:1: its columns are those of another version of boresight; give another folder", file.string()));
}

/// Makes the folder, and removes what is no record to be continued.
std::optional<std::int64_t> prepare(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw terminal::OutputError(folder.string(), error.value());
  const std::optional<std::int64_t> start_ns = start_of_record(folder);
  if (start_ns) {
    refuse_later_record(folder, *start_ns);
    refuse_other_columns(folder);
  }
  fs::remove(folder / "run.json", error);
  if (start_ns) return start_ns;
  for (const std::string_view name : run::kFileNames) {
    if (fs::is_regular_file(fs::symlink_status(folder / name, error))) fs::remove(folder / name, error);
  }
  if (fs::is_regular_file(fs::symlink_status(folder / kSnapshotsFile, error)))
    fs::remove(folder / kSnapshotsFile, error);
  return std::nullopt;
}

std::int64_t unix_now_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

LiveRecord::LiveRecord(const fs::path& folder, const VehicleConfig& vehicle)
    : folder_(folder),
      earlier_start_ns_(prepare(folder)),
      epoch_offset_ns_(unix_now_ns() - runtime::monotonic_now_ns()),
      files_([&folder] {
        std::array<std::unique_ptr<terminal::AppendedFile>, kFiles> files;
        for (std::size_t i = 0; i < kFiles; ++i) {
          files[i] = std::make_unique<terminal::AppendedFile>(folder / run::kFileNames[i]);
        }
        return files;
      }()),
      snapshots_(std::make_unique<terminal::AppendedFile>(folder / kSnapshotsFile)),
      writer_([this](run::File file, std::string_view text) { put(file, text); }, vehicle,
              earlier_start_ns_.has_value()),
      results_({[this](const run::ScanResult& result) { writer_.write(result); },
                [this](const run::EstimateResult& result) { writer_.write(result); },
                [this](const run::HealthResult& result) { writer_.write(result); }},
               earlier_start_ns_) {}

void LiveRecord::add(const monitor::Snapshot& snapshot) {
  writer_.flush();
  // scans.csv last: a scan that it names is whole in the other tables, even if the program is killed.
  for (std::size_t i = kFiles; i-- > 0;) files_[i]->flush();
  snapshots_->write(monitor::to_json(snapshot));
  snapshots_->flush();
}

void LiveRecord::finish(const runtime::Configuration& configuration, const VehicleConfig& vehicle) {
  results_.finish();
  writer_.flush();
  for (std::size_t i = kFiles; i-- > 0;) files_[i]->check();
  snapshots_->check();
  const run::LiveSummary summary{.version = BORESIGHT_VERSION,
                                 .vehicle_file = configuration.vehicle_file().string(),
                                 .configuration = configuration.directory.string(),
                                 .is_continued = earlier_start_ns_.has_value(),
                                 .epoch_offset_ns = epoch_offset_ns_,
                                 .results = results_};
  terminal::write_file(folder_ / "run.json", run::to_json(summary, vehicle));
}

}  // namespace boresight
