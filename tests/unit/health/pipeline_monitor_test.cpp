#include "services/health/core/pipeline_monitor.hpp"

#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/health/core/faults/codec.hpp"

namespace boresight::health {
namespace {

using catalogue::Service;
using enum DataQualifier;
using enum PipelineEvent;

constexpr std::int64_t kPipelineStep_ns = 2'500'000;
constexpr std::int64_t kPipelineStart_ns = 1'000'000'000'000;
constexpr std::int64_t kSilence_ns = 250'000'000;
constexpr double kVerdict_s = 0.5;

/// Four radars at 20 Hz whose scans pass three stages. A test disturbs them.
class PipelineMonitorTest : public testing::Test {
 protected:
  PipelineMonitorTest() {
    for (const Service service : kStages) {
      ServiceStatus& status = of(service);
      status.header.source_id = static_cast<std::uint32_t>(service);
      status.incarnation_ns = kPipelineStart_ns;
    }
  }

  ServiceStatus& of(Service service) { return statuses_[static_cast<std::size_t>(service)]; }
  std::uint64_t& count(Service service, Fault fault) { return of(service).faults[static_cast<std::size_t>(fault)]; }

  void step() {
    const std::int64_t tick = (now_ns_ - kPipelineStart_ns) / kPipelineStep_ns;
    if (tick % 5 == 0 && radars_send_) scan();
    for (std::size_t i = 0; i < kStages.size(); ++i) {  // heartbeats every 100 ms, not at the same time
      if (tick % 40 == static_cast<std::int64_t>(7 * i)) heartbeat(kStages[i]);
    }
    if (tick % 8 == 0) judge();
    now_ns_ += kPipelineStep_ns;
  }

  void scan() {
    ++scans_;
    monitor_.scan_arrived(now_ns_);
    if (stopped_) return;
    queueing_us_ = static_cast<float>(queueing_ms_ * 1e3);
    if (lost_every_ != 0 && scans_ % lost_every_ == 0) {
      ++count(Service::kGhostFilter, Fault::kInputDropped);
      return;
    }
    if (at_budget_every_ != 0 && scans_ % at_budget_every_ == 0) ++count(Service::kTracker, Fault::kWorkBudget);
    ++of(Service::kTracker).outputs;
    std::uniform_real_distribution<double> jitter(0.0, jitter_ms_);
    const auto latency_ns = static_cast<std::int64_t>((latency_ms_ + jitter(random_)) * 1e6);
    tracks_->header.stage(Stage::kTracker).end_ns = now_ns_;
    tracks_->header.stage(Stage::kIngest).begin_ns = now_ns_ - latency_ns;
    monitor_.observe(*tracks_, now_ns_);
  }

  void heartbeat(Service service) {
    ServiceStatus& status = of(service);
    status.queueing_max_us = service == Service::kGhostFilter ? queueing_us_ : 100.0F;
    monitor_.observe(status, now_ns_);
  }

  void judge() {
    health_ = monitor_.judge(faults_, now_ns_, {});
    seen_events_ |= health_.failed_events;
  }

  void run(double seconds) {
    const std::int64_t end_ns = now_ns_ + static_cast<std::int64_t>(seconds * 1e9);
    while (now_ns_ < end_ns) step();
  }

  /// Seconds until the verdict is not AVAILABLE; 9 if it stays so for two seconds.
  double seconds_to_verdict() {
    const std::int64_t begin_ns = now_ns_;
    while (now_ns_ < begin_ns + 2'000'000'000) {
      step();
      if (health_.data_qualifier != kAvailable) return static_cast<double>(now_ns_ - begin_ns) * 1e-9;
    }
    return 9.0;
  }

  [[nodiscard]] static std::uint32_t only(PipelineEvent event) { return 1U << static_cast<unsigned>(event); }

  /// The disturbance of `begin` gives this event alone, in time, and after `end` the pipeline recovers with hysteresis.
  template <typename Begin, typename End>
  void expect_event(PipelineEvent event, DataQualifier effect, Begin begin, End end) {
    run(2.0);
    ASSERT_EQ(health_.data_qualifier, kAvailable);
    begin();
    const double seconds = seconds_to_verdict();
    EXPECT_LT(seconds, kVerdict_s);
    RecordProperty("seconds_to_verdict", std::to_string(seconds));
    run(1.0);
    EXPECT_EQ(health_.data_qualifier, effect);
    EXPECT_EQ(seen_events_, only(event));
    end();
    run(0.1);
    EXPECT_EQ(health_.data_qualifier, effect) << "debounced";
    run(2.0);
    EXPECT_EQ(health_.data_qualifier, kAvailable);
    EXPECT_EQ(faults_.find({kind_of(event)})->status.occurrences, 1);
  }

  static constexpr std::array<Service, 4> kStages = {Service::kIngestGateway, Service::kDetectionCorrector,
                                                     Service::kGhostFilter, Service::kTracker};
  FaultMemory faults_{VehicleConfig(), FaultMemoryConfig()};
  PipelineMonitor monitor_{Config(), kSilence_ns, kPipelineStart_ns};
  std::array<ServiceStatus, catalogue::kNumberOfSupervisedServices> statuses_{};
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  std::mt19937 random_{1};
  std::int64_t now_ns_ = kPipelineStart_ns;
  PipelineHealth health_{};
  std::uint32_t seen_events_ = 0;
  std::uint64_t scans_ = 0;
  float queueing_us_ = 0.0F;
  bool radars_send_ = true;
  bool stopped_ = false;
  std::uint64_t lost_every_ = 0;
  std::uint64_t at_budget_every_ = 0;
  double queueing_ms_ = 0.3;
  double latency_ms_ = 2.0;
  double jitter_ms_ = 3.0;
};

TEST_F(PipelineMonitorTest, IsAvailableInAHealthyRunWithJitter) {
  jitter_ms_ = 45.0;
  queueing_ms_ = 20.0;
  lost_every_ = 40;  // less than one in the window
  at_budget_every_ = 10;
  run(30.0);
  EXPECT_EQ(health_.data_qualifier, kAvailable);
  EXPECT_EQ(seen_events_, 0U);
  EXPECT_NEAR(health_.latency_p99_ms, 45.0, 5.0);
  EXPECT_NEAR(health_.queueing_max_ms, 20.0, 1e-3);
  EXPECT_GT(health_.budget_hits, 0U);
}

TEST_F(PipelineMonitorTest, IsNotAvailableBeforeTheFirstTrackList) {
  judge();
  EXPECT_EQ(health_.data_qualifier, kNotAvailable);
  stopped_ = true;
  run(1.0);
  EXPECT_EQ(health_.data_qualifier, kNotAvailable);
  EXPECT_EQ(seen_events_, 0U) << "the stages start";
  stopped_ = false;
  run(0.2);
  EXPECT_EQ(health_.data_qualifier, kAvailable);
}

TEST_F(PipelineMonitorTest, ThatNeverStartsIsSilentAfterItsGrace) {
  stopped_ = true;
  run(Config().start_grace_s - 0.1);
  EXPECT_EQ(seen_events_, 0U);
  run(0.3);
  EXPECT_EQ(seen_events_, only(kSilent));
}

TEST_F(PipelineMonitorTest, LostScansReduceItWithinHalfASecond) {
  expect_event(
      kLosing, kAvailableReduced, [&] { lost_every_ = 5; }, [&] { lost_every_ = 0; });
}

TEST_F(PipelineMonitorTest, ASingleLostScanIsNoFailure) {
  run(2.0);
  ++count(Service::kTracker, Fault::kInputLost);
  run(0.2);
  EXPECT_EQ(health_.lost_scans, 1U);
  run(1.0);
  EXPECT_EQ(seen_events_, 0U);
  EXPECT_EQ(health_.lost_scans, 0U) << "over the window only";
}

TEST_F(PipelineMonitorTest, LongQueueingReducesItWithinHalfASecond) {
  expect_event(
      kQueueing, kAvailableReduced, [&] { queueing_ms_ = 30.0; }, [&] { queueing_ms_ = 0.3; });
}

TEST_F(PipelineMonitorTest, OneHeartbeatWithLongQueueingIsNoFailure) {
  run(2.0);
  queueing_ms_ = 200.0;
  run(0.1);
  queueing_ms_ = 0.3;
  run(1.0);
  EXPECT_EQ(seen_events_, 0U);
}

TEST_F(PipelineMonitorTest, WorkBudgetsReduceItWithinHalfASecond) {
  expect_event(
      kWorkBudget, kAvailableReduced, [&] { at_budget_every_ = 4; }, [&] { at_budget_every_ = 0; });
}

TEST_F(PipelineMonitorTest, LateTrackListsReduceItWithinHalfASecond) {
  expect_event(
      kLate, kAvailableReduced, [&] { latency_ms_ = 60.0; }, [&] { latency_ms_ = 2.0; });
}

TEST_F(PipelineMonitorTest, ScansWithoutTrackListsMakeItNotAvailableWithinHalfASecond) {
  expect_event(
      kSilent, kNotAvailable, [&] { stopped_ = true; }, [&] { stopped_ = false; });
}

TEST_F(PipelineMonitorTest, SilentRadarsAreNoFailure) {
  run(2.0);
  radars_send_ = false;
  run(5.0);
  radars_send_ = true;
  run(2.0);
  EXPECT_EQ(seen_events_, 0U);
  EXPECT_EQ(health_.data_qualifier, kAvailable);
}

TEST_F(PipelineMonitorTest, ARestartOfAServiceIsNoLoss) {
  count(Service::kTracker, Fault::kInputLost) = 20;
  run(2.0);
  const ServiceStatus old = of(Service::kTracker);
  ServiceStatus& tracker = of(Service::kTracker);
  tracker.incarnation_ns = now_ns_;
  tracker.outputs = 0;
  tracker.faults = {};
  run(0.2);
  monitor_.observe(old, now_ns_);  // was still in the queue
  run(2.0);
  EXPECT_EQ(seen_events_, 0U);
  EXPECT_EQ(health_.data_qualifier, kAvailable);
}

TEST_F(PipelineMonitorTest, AnotherProcessContinuesWithTheLastKnownResultUntilItIsTested) {
  run(2.0);
  at_budget_every_ = 2;
  run(1.0);
  ASSERT_EQ(health_.failed_events, only(kWorkBudget));
  std::vector<std::uint8_t> bytes(kMaxFaultMemoryBytes);
  bytes.resize(encode_fault_memory(faults_, bytes));
  faults_ = FaultMemory(VehicleConfig(), FaultMemoryConfig());
  ASSERT_EQ(decode_fault_memory(bytes, faults_), StoredFaults::kTaken);
  monitor_ = PipelineMonitor(Config(), kSilence_ns, now_ns_);
  judge();
  EXPECT_EQ(health_.data_qualifier, kNotAvailable) << "no track list yet";
  EXPECT_EQ(health_.failed_events, only(kWorkBudget));
  at_budget_every_ = 0;
  run(0.5);
  EXPECT_EQ(health_.data_qualifier, kAvailableReduced);
  run(2.0);
  EXPECT_EQ(health_.data_qualifier, kAvailable);
}

TEST_F(PipelineMonitorTest, HeartbeatsOfOtherServicesDoNotCount) {
  run(2.0);
  ServiceStatus estimator{};
  estimator.header.source_id = static_cast<std::uint32_t>(Service::kAlignmentEstimator);
  for (int i = 0; i < 10; ++i) {
    estimator.faults[static_cast<std::size_t>(Fault::kInputLost)] += 100;
    estimator.queueing_max_us = 1e6F;
    monitor_.observe(estimator, now_ns_);
    estimator.header.source_id = i % 2 == 0 ? 1 : 200;
    run(0.1);
  }
  EXPECT_EQ(seen_events_, 0U);
}

#ifndef BORESIGHT_SANITIZED
TEST_F(PipelineMonitorTest, DoesNotAllocate) {
  run(1.0);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    lost_every_ = 3;
    run(1.0);
    stopped_ = true;
    run(1.0);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_NE(health_.failed_events, 0U);
}
#endif

}  // namespace
}  // namespace boresight::health
