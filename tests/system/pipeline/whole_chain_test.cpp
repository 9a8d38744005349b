// Every process of the product on a simulated drive: no message lost, out of order or copied, and no file left behind.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;
using catalogue::Service;
using catalogue::TopicId;
using harness::Observer;
using harness::Sample;

constexpr double kDrive_s = 12.0;
constexpr std::size_t kScansPerRadar = 239;  // 12 s at 20 Hz; the phase of a radar may cost it one

/// Open files of a process: targets of /proc/<pid>/fd.
std::vector<std::string> open_files(pid_t pid) {
  std::vector<std::string> targets;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    std::error_code gone;
    const fs::path target = fs::read_symlink(entry.path(), gone);
    if (!gone) targets.push_back(target.string());
  }
  return targets;
}

std::set<std::string> leftovers() {
  std::set<std::string> found;
  for (const char* folder : {"/dev/shm", "/tmp"}) {
    for (const auto& entry : fs::directory_iterator(folder)) found.insert(entry.path().string());
  }
  return found;
}

/// One run of the drive for all cases.
class WholeChain : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    // A checkout under /tmp exists before the test.
    const std::set<std::string> before = leftovers();
    const auto recordings = harness::simulated_drive(kDrive_s);
    observer_ = std::make_unique<Observer>("-pipeline");
    harness::Domain domain("demo");
    domain.start();
    ASSERT_TRUE(domain.until(5.0, [] { return observer_->is_attached(); }));
    domain.replay(recordings);
    domain.run_for(2.0);
    for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
      const std::string service(catalogue::kServiceNames[i]);
      files_[service] = open_files(domain.supervisor().pid_of(service));
    }
    ASSERT_TRUE(domain.until(kDrive_s + 10.0, [&] { return domain.replay_has_ended(); }));
    domain.run_for(0.5);
    EXPECT_EQ(observer_->process().stop(), 0);
    domain.supervisor().stop();
    events_ = domain.supervisor().events();
    for (const std::string& entry : leftovers()) {
      if (!before.contains(entry)) left_.insert(entry);
    }
  }
  static void TearDownTestSuite() { observer_.reset(); }

  static void expect_complete(TopicId topic) {
    std::map<std::uint32_t, std::uint64_t> last_of_source;
    std::map<std::uint32_t, std::size_t> scans;
    std::uint64_t last = 0;
    for (const Sample* sample : observer_->of(topic)) {
      const MessageHeader& header = sample->header;
      EXPECT_EQ(header.sequence, last + 1);
      EXPECT_EQ(header.source_sequence, last_of_source[header.source_id] + 1) << "radar " << header.source_id;
      last = header.sequence;
      last_of_source[header.source_id] = header.source_sequence;
      ++scans[header.source_id];
    }
    EXPECT_EQ(scans.size(), 4u);
    for (const auto& [radar, count] : scans) EXPECT_GE(count, kScansPerRadar) << "radar " << radar;
  }

  static inline std::unique_ptr<Observer> observer_;
  static inline std::map<std::string, std::vector<std::string>> files_;
  static inline std::vector<supervisor::Event> events_;
  static inline std::set<std::string> left_;
};

TEST_F(WholeChain, NoRadarScanIsLost) {
  expect_complete(TopicId::kRadarScan);
}

TEST_F(WholeChain, NoCorrectedScanIsLost) {
  expect_complete(TopicId::kCorrectedScan);
}

TEST_F(WholeChain, NoClassifiedScanIsLost) {
  expect_complete(TopicId::kClassifiedScan);
}

TEST_F(WholeChain, EveryScanEndsInATrackList) {
  expect_complete(TopicId::kTrackList);
  EXPECT_EQ(observer_->of(TopicId::kTrackList).size(), observer_->of(TopicId::kRadarScan).size());
  const auto lists = observer_->of(TopicId::kTrackList);
  EXPECT_TRUE(std::any_of(lists.begin(), lists.end(), [](const Sample* s) { return s->confirmed_tracks > 0; }));
}

TEST_F(WholeChain, ThePipelineIsAvailableFromTheFirstTracksToTheEnd) {
  const auto reports = observer_->of(TopicId::kHealthReport);
  const auto is_available = [](const Sample* s) { return s->pipeline.data_qualifier == DataQualifier::kAvailable; };
  const auto first = std::find_if(reports.begin(), reports.end(), is_available);
  ASSERT_NE(first, reports.end());
  EXPECT_LT((*first)->received_ns, observer_->of(TopicId::kTrackList).front()->received_ns + 100'000'000);
  EXPECT_TRUE(std::all_of(first, reports.end(), is_available)) << "no flip";
  for (const Sample* report : reports) EXPECT_EQ(report->pipeline.failed_events, 0u);
}

TEST_F(WholeChain, StampsOfTheStagesGrow) {
  const auto lists = observer_->of(TopicId::kTrackList);
  ASSERT_FALSE(lists.empty());
  for (const Sample* sample : lists) {
    std::int64_t before_ns = 1;
    for (std::size_t i = 0; i < kNumberOfStages; ++i) {
      const StageStamp& stamp = sample->header.stages[i];
      EXPECT_GE(stamp.begin_ns, before_ns) << "stage " << i;
      EXPECT_GE(stamp.end_ns, stamp.begin_ns) << "stage " << i;
      before_ns = stamp.end_ns;
    }
    EXPECT_GE(sample->received_ns, before_ns);
  }
}

TEST_F(WholeChain, DetectionsCorrespondIndexByIndex) {
  for (const TopicId topic : {TopicId::kCorrectedScan, TopicId::kClassifiedScan}) {
    const auto samples = observer_->of(topic);
    std::size_t compared = 0;
    for (const Sample* sample : samples) {
      EXPECT_NE(sample->correspondence, 2) << "radar " << sample->header.source_id;
      if (sample->correspondence == 1) ++compared;
    }
    EXPECT_GE(compared, samples.size() * 9 / 10);
  }
}

TEST_F(WholeChain, CorrectorUsesTheEstimatesAsTheyCome) {
  std::map<std::uint32_t, std::uint64_t> last;
  std::map<std::uint32_t, std::size_t> changes;
  for (const Sample* sample : observer_->of(TopicId::kCorrectedScan)) {
    std::uint64_t& of_radar = last[sample->header.source_id];
    EXPECT_GE(sample->alignment_sequence, of_radar);
    if (sample->alignment_sequence > of_radar) ++changes[sample->header.source_id];
    of_radar = sample->alignment_sequence;
  }
  for (std::uint32_t radar = 1; radar <= 4; ++radar) EXPECT_GE(changes[radar], 40u) << "of 60, radar " << radar;
}

TEST_F(WholeChain, MisalignedRadarIsReported) {
  const auto reports = observer_->of(TopicId::kHealthReport);
  const auto misaligned = [&](std::uint32_t radar) {
    return std::any_of(reports.begin(), reports.end(), [radar](const Sample* s) {
      return s->sensor_reason[radar] == static_cast<std::uint32_t>(ExtendedQualifier::kMisaligned);
    });
  };
  EXPECT_TRUE(misaligned(2)) << "its mounting error is 2.5 deg";
  for (const std::uint32_t radar : {1u, 3u, 4u}) EXPECT_FALSE(misaligned(radar)) << "radar " << radar;
}

TEST_F(WholeChain, MessagesAreReadWhereTheyWereWritten) {
  for (const auto& topic : catalogue::kTopics) {
    const auto samples = observer_->of(topic.id);
    if (samples.empty()) continue;
    EXPECT_TRUE(samples.front()->in_shared_memory) << topic.name;
  }
}

TEST_F(WholeChain, ServicesShareNoPipesAndNoFilesButMemory) {
  // A copy between two services would need a common open pipe or file. Sockets of the middleware's registration belong
  // to one process each. Timers carry no data, and all have the same name.
  const std::vector<std::string> own = open_files(getpid());
  const std::set<std::string> inherited(own.begin(), own.end());
  std::map<std::string, std::set<std::string>> holders;
  for (const auto& [service, targets] : files_) {
    EXPECT_FALSE(targets.empty());
    for (const std::string& target : targets) {
      const bool carries_nothing = target == "/dev/null" || target == "anon_inode:[timerfd]";
      const bool shared_memory = target.rfind("/dev/shm/", 0) == 0;
      if (!shared_memory && !carries_nothing && !inherited.contains(target)) holders[target].insert(service);
    }
  }
  for (const auto& [target, services] : holders) {
    EXPECT_EQ(services.size(), 1u) << target << " is open in " << *services.begin() << " and " << *services.rbegin();
  }
}

TEST_F(WholeChain, NoServiceAllocatesPerScanOrRejectsAnything) {
  std::map<std::uint32_t, const Sample*> last;
  for (const Sample* sample : observer_->of(TopicId::kServiceStatus)) last[sample->header.source_id] = sample;
  for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
    const std::string service(catalogue::kServiceNames[i]);
    ASSERT_TRUE(last.contains(static_cast<std::uint32_t>(i))) << service;
    const ServiceStatus& status = last[static_cast<std::uint32_t>(i)]->status;
    EXPECT_EQ(status.heap_allocations, 0u) << service;
    EXPECT_GT(status.inputs, 0u) << service;
    for (const Fault fault :
         {Fault::kInputLost, Fault::kLoanFailed, Fault::kWireLength, Fault::kWireValue, Fault::kTimeJump,
          Fault::kVersionMismatch, Fault::kForeignMemory, Fault::kCapacity, Fault::kLink}) {
      EXPECT_EQ(status.faults[static_cast<std::size_t>(fault)], 0u)
          << service << ", fault " << static_cast<int>(fault) << ": " << status.last_fault.data();
    }
  }
}

TEST_F(WholeChain, EveryProcessEndsWithZeroAndLeavesNothing) {
  std::size_t exits = 0;
  for (const supervisor::Event& event : events_) {
    if (event.kind != supervisor::EventKind::kExited) continue;
    ++exits;
    EXPECT_EQ(event.detail, "exit code 0") << event.process;
  }
  EXPECT_EQ(exits, files_.size() + 2) << "services, replay and RouDi";
  EXPECT_EQ(left_, (std::set<std::string>{"/tmp/domain", "/tmp/drive"})) << "only what the test itself made";
}

}  // namespace
}  // namespace boresight
