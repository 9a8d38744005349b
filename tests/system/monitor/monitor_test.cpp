// `boresight monitor` beside the running system: its records can be read back, and write errors are reported.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "services/boresight/monitor/scan_record.hpp"
#include "services/boresight/monitor/snapshot.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight {
namespace {

using Line = monitor::ScanRecordReader::Line;

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

TEST(Monitor, RecordsCanBeReadBackAndWriteErrorsAreReported) {
  const auto recordings = harness::simulated_drive(3.0);
  harness::Domain domain("demo");
  domain.start();
  harness::Child whole =
      monitor_with({"--record", "/tmp/record.txt", "--record-scans", "/tmp/scans.txt"}, "/tmp/whole");
  harness::Child no_scans = monitor_with({"--record-scans", "/dev/full"}, "/tmp/no_scans");
  harness::Child no_snapshots = monitor_with({"--record", "/dev/full"}, "/tmp/no_snapshots");
  domain.run_for(1.0);
  domain.replay(recordings);
  ASSERT_TRUE(domain.until(10.0, [&] { return domain.replay_has_ended(); }));
  domain.run_for(1.0);
  EXPECT_EQ(whole.stop(), 0) << text_of("/tmp/whole");
  EXPECT_EQ(no_scans.stop(), 3);
  EXPECT_EQ(no_snapshots.stop(), 3);
  EXPECT_EQ(text_of("/tmp/no_scans"), "boresight monitor: /dev/full: cannot be written: No space left on device\n");
  EXPECT_EQ(text_of("/tmp/no_snapshots"), text_of("/tmp/no_scans"));

  const auto scan = std::make_unique<ClassifiedScan>();
  const auto tracks = std::make_unique<TrackList>();
  std::ifstream record("/tmp/scans.txt");
  monitor::ScanRecordReader reader(record, "scans.txt");
  std::size_t scans = 0, lists = 0;
  for (Line line = reader.next(*scan, *tracks); line != Line::kEnd; line = reader.next(*scan, *tracks)) {
    ++(line == Line::kScan ? scans : lists);
  }
  EXPECT_EQ(reader.damaged().count, 0u) << reader.damaged().first;
  EXPECT_GT(scans, 200u) << "of some 240";
  EXPECT_EQ(lists, scans);
  std::ifstream snapshots("/tmp/record.txt");
  monitor::DamagedLines damaged;
  EXPECT_GT(monitor::read_record(snapshots, "record.txt", damaged).size(), 5u);
  EXPECT_EQ(damaged.count, 0u) << damaged.first;
}

}  // namespace
}  // namespace boresight
