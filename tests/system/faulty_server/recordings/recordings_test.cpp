// Every recording of scenarios.py through the gateway: exactly the valid scans are delivered, bitwise equal. Faults are
// counted with their text, for the radar that sent them.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interfaces/messages/names.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "tests/system/faulty_server/known.hpp"

namespace boresight::faulty_server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRadars = 2;

struct Expectation {
  std::string name;
  std::vector<KnownScan> delivered;
  std::vector<KnownScan> optional;        ///< may be delivered
  std::vector<std::int64_t> ego_eighths;  ///< speeds in 1/8 m/s
  bool at_least = false;                  ///< the numbers of faults are minimums, and other faults may occur
  std::vector<std::int64_t> e2e;          ///< lost, repeated, wrong of radar 1, then of 2; empty: not checked
  std::vector<std::string> faults;        ///< "count|kind|radar|words of the reason"
};

std::vector<KnownScan> known_scans(const std::vector<std::int64_t>& flat) {
  std::vector<KnownScan> scans;
  for (std::size_t i = 0; i + 4 <= flat.size(); i += 4) {
    scans.push_back({static_cast<std::uint32_t>(flat[i]), static_cast<std::uint32_t>(flat[i + 1]),
                     static_cast<std::uint32_t>(flat[i + 2]), static_cast<Variant>(flat[i + 3])});
  }
  return scans;
}

std::vector<Expectation> read_expectations(const fs::path& file) {
  const config::Range any{0, 1e6}, number{0, 4294967295.0};
  auto root = config::Reader::open(file);
  std::vector<Expectation> all;
  for (config::Reader& scenario : root.tables("scenario")) {
    Expectation& e = all.emplace_back();
    e.name = scenario.text("name", "");
    e.delivered = known_scans(scenario.integers("delivered", any, number, {}));
    e.optional = known_scans(scenario.integers("optional", any, number, {}));
    e.ego_eighths = scenario.integers("egos", any, number, {});
    e.at_least = scenario.boolean("at_least", false);
    e.e2e = scenario.integers("e2e", any, number, {});
    e.faults = scenario.texts("faults", {});
  }
  root.finish();
  return all;
}

/// Results of one recording.
class Outcome : public ingest::Sink {
 public:
  explicit Outcome(const std::vector<KnownScan>& possible) : possible_(possible) {}
  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override {
    const auto known = std::find_if(possible_.begin(), possible_.end(), [&](const KnownScan& k) {
      return k.radar == radar_id && k.cycle == scan_->cycle_counter;
    });
    if (known == possible_.end()) {
      delivered.push_back({radar_id, scan_->cycle_counter, scan_->number_of_valid_detections, Variant::kPlain});
      return;
    }
    delivered.push_back(*known);
    EXPECT_EQ(difference(*scan_, *known), "") << "radar " << radar_id << ", cycle " << known->cycle;
    EXPECT_EQ(time.source, TimeSource::kSensorSynchronised);
  }
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const ingest::MeasurementTime&) override {
    ego_eighths.push_back(static_cast<std::int64_t>(ego_.speed_mps * 8));
  }
  void fault(Fault kind, std::string_view what, std::uint32_t radar_id) override {
    ++faults[std::string(name_of(kind)) + "|" + std::to_string(radar_id) + "|" + std::string(what)];
  }
  SourceStatistics& statistics(std::uint32_t radar_id) override { return statistics_.at(radar_id); }

  std::vector<KnownScan> delivered;
  std::vector<std::int64_t> ego_eighths;
  std::map<std::string, std::int64_t> faults;  ///< by "kind|radar|reason"

 private:
  const std::vector<KnownScan>& possible_;
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  EgoMotion ego_{};
  std::array<SourceStatistics, kRadars + 1> statistics_{};
};

void judge_faults(const Expectation& expected, std::map<std::string, std::int64_t> faults) {
  for (const std::string& line : expected.faults) {
    const std::size_t first = line.find('|'), last = line.rfind('|');
    const std::int64_t wanted = std::stoll(line.substr(0, first));
    const std::string kind_and_radar = line.substr(first + 1, last - first), words = line.substr(last + 1);
    std::int64_t found = 0;
    for (auto& [reason, count] : faults) {
      const bool fits =
          kind_and_radar == "any|0|" || (reason.starts_with(kind_and_radar) && reason.find(words) != std::string::npos);
      if (fits) found += std::exchange(count, 0);
    }
    if (expected.at_least) {
      EXPECT_GE(found, wanted) << line;
    } else {
      EXPECT_EQ(found, wanted) << line;
    }
  }
  for (const auto& [reason, count] : faults) {
    if (!expected.at_least) {
      EXPECT_EQ(count, 0) << "not expected: " << reason;
    }
  }
}

/// "radar/cycle" of the `scans` that are missing in the others.
std::string without(const std::vector<KnownScan>& scans, const std::vector<KnownScan>& others) {
  std::string text;
  for (const KnownScan& scan : scans) {
    if (std::find(others.begin(), others.end(), scan) != others.end()) continue;
    text += std::to_string(scan.radar) + "/" + std::to_string(scan.cycle) + " ";
  }
  return text;
}

void judge(const Expectation& expected, const VehicleConfig& vehicle, const fs::path& recording) {
  std::vector<KnownScan> possible = expected.delivered;
  possible.insert(possible.end(), expected.optional.begin(), expected.optional.end());
  Outcome outcome(possible);
  ingest::Gateway gateway(vehicle, outcome);
  const auto reader =
      recording::open_recording(recording, [](const std::string& problem) { ADD_FAILURE() << problem; });
  recording::Frame frame;
  while (reader->next(frame)) gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
  gateway.finish();

  // Optional scans are removed; the others must be equal and in order.
  std::erase_if(outcome.delivered, [&](const KnownScan& scan) {
    return std::find(expected.optional.begin(), expected.optional.end(), scan) != expected.optional.end();
  });
  EXPECT_EQ(without(expected.delivered, outcome.delivered), "") << "not delivered";
  EXPECT_EQ(without(outcome.delivered, expected.delivered), "") << "should not have been delivered";
  EXPECT_EQ(outcome.delivered, expected.delivered) << "order, or twice";
  EXPECT_EQ(outcome.ego_eighths, expected.ego_eighths);
  judge_faults(expected, outcome.faults);
  if (expected.e2e.empty()) return;
  std::vector<std::int64_t> e2e;
  for (std::uint32_t radar = 1; radar <= kRadars; ++radar) {
    const SourceStatistics& s = outcome.statistics(radar);
    for (const std::uint64_t n : {s.e2e_lost, s.e2e_repeated, s.e2e_wrong}) e2e.push_back(static_cast<std::int64_t>(n));
  }
  EXPECT_EQ(e2e, expected.e2e) << "lost, repeated, wrong";
}

TEST(FaultyServer, BadMessagesAreCountedAndGoodOnesDelivered) {
  const fs::path room = fs::path(BORESIGHT_SOURCE_DIR) / "tests/system/faulty_server";
  const fs::path folder = fs::temp_directory_path() / ("faulty_server_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string command = "/usr/bin/python3 " + (room / "scenarios.py").string() + " " + folder.string();
  const int status = std::system(command.c_str());
  if (WIFEXITED(status) && (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127))
    GTEST_SKIP() << "skipped: no scapy";
  ASSERT_EQ(status, 0);

  const VehicleConfig vehicle = config::read_vehicle_file(room / "vehicle.toml");
  const std::vector<Expectation> expectations = read_expectations(folder / "expected.toml");
  std::size_t scans = 0, faults = 0;
  for (const Expectation& expected : expectations) {
    SCOPED_TRACE(expected.name);
    judge(expected, vehicle, folder / (expected.name + ".pcap"));
    scans += expected.delivered.size();
    for (const std::string& line : expected.faults) faults += std::stoul(line);
  }
  std::printf("%zu scenarios, %zu scans right to the bit, %zu faults expected\n", expectations.size(), scans, faults);
  if (!HasFailure()) fs::remove_all(folder);
}

}  // namespace
}  // namespace boresight::faulty_server
