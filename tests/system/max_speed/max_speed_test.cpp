// A replay at the largest speed: no scan is lost, and a loss that happens is reported.
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>
#include <signal.h>

#include "services/common/runtime/exit_codes.hpp"
#include "services/common/vehicle/drive_truth.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::TopicId;
using harness::Observer;
using harness::Sample;

constexpr double kDrive_s = 8.0;

std::string replay_log() {
  std::ostringstream text;
  text << std::ifstream("/tmp/domain/logs/replay.log").rdbuf();
  return text.str();
}

std::map<std::uint32_t, std::uint64_t> messages_by_radar(const Observer& observer, TopicId topic) {
  std::map<std::uint32_t, std::uint64_t> count;
  for (const Sample* sample : observer.of(topic)) ++count[sample->header.source_id];
  return count;
}

/// The exit code of the replay; −1 if it does not end in time.
int exit_code_of_replay(harness::Domain& domain, double seconds) {
  int code = -1;
  const bool ended = domain.until(seconds, [&] {
    const auto status = domain.supervisor().independent_result("replay");
    if (status) code = WIFEXITED(*status) ? WEXITSTATUS(*status) : -WTERMSIG(*status);
    return status.has_value();
  });
  EXPECT_TRUE(ended) << replay_log();
  return code;
}

class MaxSpeed : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove("/tmp/domain/logs/replay.log");
    recordings_ = harness::simulated_drive(kDrive_s);
  }
  std::vector<std::filesystem::path> recordings_;
};

TEST_F(MaxSpeed, EveryScanOfTheRecordingHasATrackList) {
  Observer observer("-max-speed");
  harness::Domain domain("demo");
  domain.start();
  ASSERT_TRUE(domain.until(5.0, [&] { return observer.is_attached(); }));
  domain.replay(recordings_, {"--speed", "max"});
  EXPECT_EQ(exit_code_of_replay(domain, 40.0), exit_code::kSuccess) << replay_log();
  domain.run_for(0.3);
  EXPECT_EQ(observer.process().stop(), 0);

  std::ifstream truth("/tmp/drive/truth.csv");
  std::map<std::uint32_t, std::uint64_t> sent;
  for (const auto& [radar, values] : read_drive_truth(truth).radars) sent[radar] = values.scans.value_or(0);
  ASSERT_EQ(sent.size(), 4u);
  EXPECT_EQ(messages_by_radar(observer, TopicId::kRadarScan), sent);
  EXPECT_EQ(messages_by_radar(observer, TopicId::kTrackList), sent);
  std::map<std::uint32_t, std::uint64_t> lost;
  for (const Sample* sample : observer.of(TopicId::kServiceStatus)) {
    lost[sample->header.source_id] = sample->status.faults[static_cast<std::size_t>(Fault::kInputLost)];
  }
  for (const auto& [service, inputs] : lost) EXPECT_EQ(inputs, 0u) << catalogue::kServiceNames[service];
}

TEST_F(MaxSpeed, LossOfAScanIsReportedByTheExitCode) {
  Observer observer("-loss");
  harness::Domain domain("demo");
  domain.start();
  ASSERT_TRUE(domain.until(5.0, [&] { return observer.is_attached(); }));
  domain.replay(recordings_, {"--speed", "max"});
  ASSERT_TRUE(domain.until(10.0, [&] { return observer.of(TopicId::kTrackList).size() >= 40; }));
  // Stopped for longer than timeout_s: the replay no longer waits, and queues overflow.
  const pid_t ghost_filter = domain.supervisor().pid_of("ghost_filter");
  kill(ghost_filter, SIGSTOP);
  domain.run_for(4.0);
  kill(ghost_filter, SIGCONT);
  EXPECT_EQ(exit_code_of_replay(domain, 40.0), exit_code::kFinding) << replay_log();
  EXPECT_NE(replay_log().find("no track list comes any more"), std::string::npos) << replay_log();
}

TEST_F(MaxSpeed, ReplayWithoutATrackerEndsAndStatesThatNoneRuns) {
  harness::Domain domain("demo", {"tracker"});
  domain.start();
  domain.replay(recordings_, {"--speed", "max"});
  EXPECT_GE(exit_code_of_replay(domain, 40.0), 0);
  EXPECT_NE(replay_log().find("no tracker runs"), std::string::npos) << replay_log();
}

}  // namespace
}  // namespace boresight
