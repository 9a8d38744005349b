// A ghost filter that stands still while scans queue up: then the newest of each radar goes first, and the older ones
// are dropped, counted and flagged. Latencies are published.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <signal.h>

#include "services/common/runtime/clock.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::Service;
using catalogue::TopicId;
using harness::Observer;
using harness::Sample;

constexpr double kDrive_s = 5.0;
constexpr double kStandstill_s = 0.4;
constexpr std::size_t kRadars = 4;
constexpr std::int64_t kCycle_ns = 50'000'000;

/// A scan in every stage.
using ScanId = std::pair<std::uint32_t, std::int64_t>;

ScanId id_of(const Sample& sample) {
  return {sample.header.source_id, sample.header.measurement_time_ns};
}

/// One drive for all cases, in which the ghost filter stands still once.
class SlowStage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto recordings = harness::simulated_drive(kDrive_s);
    observer_ = std::make_unique<Observer>("-slow-stage");
    harness::Domain domain("demo");
    domain.start();
    ASSERT_TRUE(domain.until(5.0, [] { return observer_->is_attached(); }));
    domain.replay(recordings);
    ASSERT_TRUE(domain.until(10.0, [] { return observer_->of(TopicId::kTrackList).size() >= 100; }));
    const pid_t ghost_filter = domain.supervisor().pid_of("ghost_filter");
    kill(ghost_filter, SIGSTOP);
    domain.run_for(kStandstill_s);
    continued_ns_ = runtime::monotonic_now_ns();
    kill(ghost_filter, SIGCONT);
    ASSERT_TRUE(domain.until(kDrive_s + 10.0, [&] { return domain.replay_has_ended(); }));
    domain.run_for(0.5);
    EXPECT_EQ(observer_->process().stop(), 0);
  }
  static void TearDownTestSuite() { observer_.reset(); }

  static std::uint64_t count_of(Service service, Fault fault) {
    std::uint64_t count = 0;
    for (const Sample* sample : observer_->of(TopicId::kServiceStatus)) {
      if (sample->header.source_id == static_cast<std::uint32_t>(service))
        count = sample->status.faults[static_cast<std::size_t>(fault)];
    }
    return count;
  }
  static std::set<ScanId> scans_of(TopicId topic) {
    std::set<ScanId> scans;
    for (const Sample* sample : observer_->of(topic)) scans.insert(id_of(*sample));
    return scans;
  }

  static inline std::unique_ptr<Observer> observer_;
  static inline std::int64_t continued_ns_ = 0;
};

TEST_F(SlowStage, TheNewestScanOfEachRadarGoesFirst) {
  std::map<std::uint32_t, const Sample*> first;
  for (const Sample* sample : observer_->of(TopicId::kClassifiedScan)) {
    if (sample->header.stage(Stage::kGhostFilter).begin_ns >= continued_ns_)
      first.try_emplace(sample->header.source_id, sample);
  }
  ASSERT_EQ(first.size(), kRadars);
  std::size_t of_before = 0;
  for (const auto& [radar, sample] : first) {
    const std::int64_t waited_ns = continued_ns_ - sample->header.stage(Stage::kCorrector).end_ns;
    EXPECT_LT(waited_ns, 2 * kCycle_ns) << "radar " << radar;
    if (waited_ns > 0) ++of_before;
  }
  EXPECT_GT(of_before, 0u) << "at least one of them waited";
}

TEST_F(SlowStage, EveryDroppedScanIsCountedByItsStageAndNoneIsLost) {
  const std::array<std::pair<Service, std::pair<TopicId, TopicId>>, 3> stages = {
      {{Service::kDetectionCorrector, {TopicId::kRadarScan, TopicId::kCorrectedScan}},
       {Service::kGhostFilter, {TopicId::kCorrectedScan, TopicId::kClassifiedScan}},
       {Service::kTracker, {TopicId::kClassifiedScan, TopicId::kTrackList}}}};
  for (const auto& [service, topics] : stages) {
    const auto in = scans_of(topics.first), out = scans_of(topics.second);
    EXPECT_TRUE(std::includes(in.begin(), in.end(), out.begin(), out.end()));
    EXPECT_EQ(count_of(service, Fault::kInputDropped), in.size() - out.size()) << name_of(service);
    EXPECT_EQ(count_of(service, Fault::kInputLost), 0u) << name_of(service);
  }
  const auto cycles = static_cast<std::size_t>(kStandstill_s * 1e9) / kCycle_ns;
  EXPECT_GE(count_of(Service::kGhostFilter, Fault::kInputDropped), kRadars * (cycles - 2));
}

TEST_F(SlowStage, TheScanAfterDroppedOnesIsFlaggedUpToTheTrackList) {
  const auto corrected = observer_->of(TopicId::kCorrectedScan);
  const auto classified_ids = scans_of(TopicId::kClassifiedScan);
  std::map<ScanId, bool> dropped_before;
  std::map<std::uint32_t, bool> is_dropped;
  for (const Sample* sample : corrected) {
    const bool is_classified = classified_ids.contains(id_of(*sample));
    bool& dropped = is_dropped[sample->header.source_id];
    if (is_classified) dropped_before[id_of(*sample)] = dropped || (sample->flags & pipeline_flag::kScansDropped) != 0;
    dropped = !is_classified;
  }
  std::size_t flagged = 0;
  for (const Sample* sample : observer_->of(TopicId::kClassifiedScan)) {
    const bool has_flag = (sample->flags & pipeline_flag::kScansDropped) != 0;
    EXPECT_EQ(has_flag, dropped_before.at(id_of(*sample))) << "radar " << sample->header.source_id;
    if (has_flag) ++flagged;
  }
  EXPECT_GE(flagged, kRadars);
  for (const Sample* sample : observer_->of(TopicId::kTrackList)) {
    const bool has_flag = (sample->flags & pipeline_flag::kScansDropped) != 0;
    EXPECT_TRUE(has_flag || !dropped_before.at(id_of(*sample))) << "radar " << sample->header.source_id;
  }
}

TEST_F(SlowStage, HeartbeatsStateTheLatencyFromArrivalOfEveryStage) {
  const std::array<std::pair<Service, TopicId>, 3> stages = {{{Service::kDetectionCorrector, TopicId::kCorrectedScan},
                                                              {Service::kGhostFilter, TopicId::kClassifiedScan},
                                                              {Service::kTracker, TopicId::kTrackList}}};
  for (std::size_t i = 0; i < stages.size(); ++i) {
    double stamped_max_us = 0.0;
    for (const Sample* sample : observer_->of(stages[i].second)) {
      const auto& stamps = sample->header.stages;
      const std::int64_t latency_ns = stamps[i + 1].end_ns - stamps[0].begin_ns;
      stamped_max_us = std::max(stamped_max_us, 1e-3 * static_cast<double>(latency_ns));
    }
    double reported_max_us = 0.0;
    std::size_t outputs = 0;
    for (const Sample* sample : observer_->of(TopicId::kServiceStatus)) {
      if (sample->header.source_id != static_cast<std::uint32_t>(stages[i].first)) continue;
      reported_max_us = std::max<double>(reported_max_us, sample->status.latency_max_us);
      outputs += sample->status.latency_count;
      EXPECT_LE(sample->status.latency_mean_us, sample->status.latency_max_us);
    }
    EXPECT_NEAR(reported_max_us, stamped_max_us, 1e-6 * stamped_max_us) << name_of(stages[i].first);
    EXPECT_EQ(outputs, observer_->of(stages[i].second).size()) << name_of(stages[i].first);
  }
}

TEST_F(SlowStage, HeartbeatsStateTheLongestTimeThatAScanWaitedForTheStage) {
  const std::array<std::pair<Service, TopicId>, 3> stages = {{{Service::kDetectionCorrector, TopicId::kCorrectedScan},
                                                              {Service::kGhostFilter, TopicId::kClassifiedScan},
                                                              {Service::kTracker, TopicId::kTrackList}}};
  for (std::size_t i = 0; i < stages.size(); ++i) {
    double stamped_max_us = 0.0;
    for (const Sample* sample : observer_->of(stages[i].second)) {
      const auto& stamps = sample->header.stages;
      stamped_max_us = std::max(stamped_max_us, 1e-3 * static_cast<double>(stamps[i + 1].begin_ns - stamps[i].end_ns));
    }
    double reported_max_us = 0.0;
    for (const Sample* sample : observer_->of(TopicId::kServiceStatus)) {
      if (sample->header.source_id == static_cast<std::uint32_t>(stages[i].first))
        reported_max_us = std::max<double>(reported_max_us, sample->status.queueing_max_us);
    }
    EXPECT_NEAR(reported_max_us, stamped_max_us, 1e-6 * stamped_max_us) << name_of(stages[i].first);
  }
}

TEST_F(SlowStage, HealthReportsTheDroppedScansAndTheLatencyOfTheStage) {
  constexpr auto kGhostFilter = static_cast<std::size_t>(Service::kGhostFilter);
  std::uint64_t dropped = 0;
  float latency_max_us = 0.0F;
  bool is_degraded_later = false;
  for (const Sample* report : observer_->of(TopicId::kHealthReport)) {
    dropped = report->dropped_inputs[kGhostFilter];
    latency_max_us = std::max(latency_max_us, report->latency_max_us[kGhostFilter]);
    const bool is_later = report->received_ns > continued_ns_ + 600'000'000;  // no longer by the missed output deadline
    is_degraded_later |= is_later && report->services[kGhostFilter] == ServiceCondition::kDegraded;
  }
  EXPECT_GT(dropped, 0u);
  EXPECT_EQ(dropped, count_of(Service::kGhostFilter, Fault::kInputDropped));
  EXPECT_TRUE(is_degraded_later);
  float heartbeat_max_us = 0.0F;
  for (const Sample* sample : observer_->of(TopicId::kServiceStatus)) {
    if (sample->header.source_id == kGhostFilter)
      heartbeat_max_us = std::max(heartbeat_max_us, sample->status.latency_max_us);
  }
  EXPECT_EQ(latency_max_us, heartbeat_max_us);
}

}  // namespace
}  // namespace boresight
