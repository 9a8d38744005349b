// The record of `boresight monitor`: a run folder (config/schema/run.md) that grows while the system runs.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/run/live_results.hpp"
#include "services/boresight/run/writer.hpp"
#include "services/boresight/terminal/appended_file.hpp"
#include "services/common/runtime/options.hpp"

namespace boresight {

/// A record that is in the folder already is continued. run.json is written by finish(): where it is, the folder is
/// whole. Errors of writing are kept until finish(), so that the live view goes on.
class LiveRecord {
 public:
  /// Makes the folder. Throws terminal::OutputError, or std::runtime_error for tables of another version and for a
  /// record that begins later than now; such a folder stays as it is.
  LiveRecord(const std::filesystem::path& folder, const VehicleConfig& vehicle);

  template <typename Message>
  void observe(const Message& message) {
    results_.observe(message);
  }
  /// Appends the snapshot, and hands over all rows up to now.
  void add(const monitor::Snapshot& snapshot);
  /// Throws terminal::OutputError if anything was lost.
  void finish(const runtime::Configuration& configuration, const VehicleConfig& vehicle);

 private:
  static constexpr std::size_t kFiles = run::kFileNames.size();
  void put(run::File file, std::string_view text) { files_[static_cast<std::size_t>(file)]->write(text); }

  std::filesystem::path folder_;
  std::optional<std::int64_t> earlier_start_ns_;
  std::int64_t epoch_offset_ns_;
  std::array<std::unique_ptr<terminal::AppendedFile>, kFiles> files_;
  std::unique_ptr<terminal::AppendedFile> snapshots_;
  run::Writer writer_;
  run::LiveResults results_;
};

}  // namespace boresight
