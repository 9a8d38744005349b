// `boresight monitor` beside the running system: its run folder can be read back, and write errors are reported.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <unistd.h>

#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/report/recorded_scans.hpp"
#include "services/boresight/run/rows.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;

harness::Child monitor_with(const std::vector<std::string>& options, const std::string& errors) {
  return harness::Child([&options, &errors] {
    if (std::freopen("/dev/null", "w", stdout) == nullptr) return 90;
    if (std::freopen(errors.c_str(), "w", stderr) == nullptr) return 90;
    const std::string config = harness::shipped_configuration().string();
    std::vector<const char*> words = {"boresight", "monitor", "--config", config.c_str(), "--vehicle", "demo"};
    for (const std::string& option : options) words.push_back(option.c_str());
    words.push_back(nullptr);
    execv(BORESIGHT_BINARY_DIR "/boresight", const_cast<char* const*>(words.data()));
    return 91;
  });
}

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A run folder in which one file cannot be written.
fs::path folder_without_room(const std::string& name, const std::string& file) {
  const fs::path folder = "/tmp/" + name;
  fs::create_directories(folder);
  fs::create_symlink("/dev/full", folder / file);
  return folder;
}

TEST(Monitor, SaysOnceThatItWaitsForRouDiAndGoesOnWaiting) {
  harness::Child monitor = monitor_with({}, "/tmp/waiting");
  const auto seconds_later = [](int seconds) { std::this_thread::sleep_for(std::chrono::seconds(seconds)); };
  seconds_later(1);
  EXPECT_EQ(text_of("/tmp/waiting"), "");
  seconds_later(3);
  const std::string message =
      "boresight monitor: waiting for RouDi; `boresight supervise` starts RouDi and the services\n";
  EXPECT_EQ(text_of("/tmp/waiting"), message);
  harness::Domain domain("demo");
  domain.start();
  domain.run_for(1.0);
  EXPECT_EQ(monitor.stop(), 0) << text_of("/tmp/waiting");
  EXPECT_EQ(text_of("/tmp/waiting"), message);
}

TEST(Monitor, RecordThatBeginsLaterThanNowIsNotContinued) {
  const fs::path folder = "/tmp/record_before_restart";
  fs::create_directories(folder);
  std::string scans(run::kScansHeader);
  scans += "\n2.000000,9000000002000000000,1,7,0,,3.5,0,0,0,0,0,0,0,0,,0\n";
  std::ofstream(folder / "scans.csv") << scans;
  std::ofstream(folder / "run.json") << "{}\n";
  harness::Child monitor = monitor_with({"--record", folder.string()}, "/tmp/not_continued");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_EQ(monitor.stop(), 3);
  EXPECT_THAT(text_of("/tmp/not_continued"),
              ::testing::ContainsRegex("^boresight monitor: /tmp/record_before_restart: its record begins at "
                                       "9000000000.000 s of CLOCK_MONOTONIC, later than now, [0-9]+\\.[0-9]+ s: "));
  EXPECT_EQ(text_of(folder / "scans.csv"), scans);
  EXPECT_TRUE(fs::exists(folder / "run.json"));
}

TEST(Monitor, RunFolderCanBeReadBackAndWriteErrorsAreReported) {
  const auto recordings = harness::simulated_drive(3.0);
  const fs::path no_scans_folder = folder_without_room("no_scans_run", "scans.csv"),
                 no_snapshots_folder = folder_without_room("no_snapshots_run", "monitor.jsonl");
  harness::Domain domain("demo");
  domain.start();
  harness::Child whole = monitor_with({"--record", "/tmp/whole_run"}, "/tmp/whole");
  harness::Child no_scans = monitor_with({"--record", no_scans_folder.string()}, "/tmp/no_scans");
  harness::Child no_snapshots = monitor_with({"--record", no_snapshots_folder.string()}, "/tmp/no_snapshots");
  domain.run_for(1.0);
  domain.replay(recordings);
  ASSERT_TRUE(domain.until(10.0, [&] { return domain.replay_has_ended(); }));
  domain.run_for(1.0);
  EXPECT_EQ(whole.stop(), 0) << text_of("/tmp/whole");
  EXPECT_EQ(no_scans.stop(), 3);
  EXPECT_EQ(no_snapshots.stop(), 3);
  const std::string reason = ": cannot be written: No space left on device\n";
  EXPECT_EQ(text_of("/tmp/no_scans"), "boresight monitor: " + (no_scans_folder / "scans.csv").string() + reason);
  EXPECT_EQ(text_of("/tmp/no_snapshots"),
            "boresight monitor: " + (no_snapshots_folder / "monitor.jsonl").string() + reason);

  const auto scan = std::make_unique<ClassifiedScan>();
  const auto tracks = std::make_unique<TrackList>();
  report::RecordedScans record("/tmp/whole_run");
  std::size_t scans = 0, confirmed = 0;
  while (record.next(*scan, *tracks)) {
    ++scans;
    confirmed += tracks->number_of_confirmed_tracks;
  }
  EXPECT_GT(scans, 200u) << "of some 240";
  EXPECT_GT(confirmed, 0u);
  std::ifstream snapshots("/tmp/whole_run/monitor.jsonl");
  monitor::DamagedLines damaged;
  EXPECT_GT(monitor::read_snapshots(snapshots, "monitor.jsonl", damaged).size(), 5u);
  EXPECT_EQ(damaged.count, 0u) << damaged.first;
}

}  // namespace
}  // namespace boresight
