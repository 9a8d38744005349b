// A short simulated drive as recordings, and what the chain writes for it, in memory.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "services/boresight/run/chain.hpp"
#include "services/boresight/run/gateway_feed.hpp"
#include "services/boresight/run/writer.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/simulator/drive_writer.hpp"

namespace boresight::run::testing {

inline VehicleConfig demo_vehicle() {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
}

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("unit_run." + name + "." + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The demo drive of some seconds, written once for the whole test program.
inline const simulator::DriveFiles& demo_drive() {
  static const TemporaryFolder folder("drive");
  static const simulator::DriveFiles files =
      simulator::write_drive(simulator::scenario("demo_drive"), demo_vehicle(), 42, 4.0, folder.path(), [](double) {});
  return files;
}

/// A writer whose files are texts.
struct TextFiles {
  std::array<std::string, kFileNames.size()> texts;
  Writer writer{[this](File file, std::string_view text) { texts[static_cast<std::size_t>(file)] += text; }, {}};
  [[nodiscard]] Listeners listeners() {
    return {[this](const ScanResult& r) { writer.write(r); }, [this](const EstimateResult& r) { writer.write(r); },
            [this](const HealthResult& r) { writer.write(r); }};
  }
  [[nodiscard]] const std::string& of(File file) const { return texts[static_cast<std::size_t>(file)]; }
};

/// Plays recordings through the gateway.
inline void play(const std::vector<std::filesystem::path>& recordings, const VehicleConfig& vehicle, Chain& chain,
                 GatewayFeed& feed) {
  const auto reader = recording::open_recordings(recordings, [](const std::string&) {});
  ingest::Gateway gateway(vehicle, feed);
  recording::Frame frame;
  while (reader->next(frame)) {
    chain.advance(frame.stamp_ns);
    gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
  }
  gateway.finish();
  chain.finish();
}

/// Rows of a table, by the names of the header line.
using Table = std::vector<std::map<std::string, std::string>>;

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

inline Table table_of(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells_of(line);
  Table rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells.at(i);
  }
  return rows;
}

}  // namespace boresight::run::testing
