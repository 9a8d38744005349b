// A stage of the pipeline is slow, stands still, or dies: the overall verdict is no longer AVAILABLE within half a
// second. Without a fault it stays AVAILABLE.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>

#include "services/common/runtime/clock.hpp"
#include "services/health/dds/diagnostics_reader.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::TopicId;
using harness::Observer;
using harness::Sample;

constexpr double kDrive_s = 50.0;
constexpr double kVerdict_s = 0.5;
constexpr double kHealthy_s = 5.0;
constexpr double kRecovery_s = 10.0;  // a service counts as restarted for 3 s, losses count for 2 s

constexpr const char* kDdsDomain = "79";

/// Samples of boresight/system_health with the time of their reception.
class Subscriber {
 public:
  /// Seconds from `begin_ns` to the first sample that is not AVAILABLE; negative without one.
  [[nodiscard]] double seconds_to_verdict(std::int64_t begin_ns) {
    const std::lock_guard lock(mutex_);
    for (const auto& [time_ns, overall] : samples_) {
      if (time_ns >= begin_ns && overall != diagnostics::AVAILABLE)
        return static_cast<double>(time_ns - begin_ns) * 1e-9;
    }
    return -1.0;
  }

 private:
  void take(const diagnostics::SystemHealth& sample) {
    const std::lock_guard lock(mutex_);
    samples_.emplace_back(runtime::monotonic_now_ns(), sample.overall());
  }
  std::mutex mutex_;
  std::vector<std::pair<std::int64_t, diagnostics::DataQualifier>> samples_;
  dds::DiagnosticsReader reader_{{.domain = static_cast<std::uint32_t>(std::atoi(kDdsDomain)), .command_key_file = {}},
                                 {.on_sensor_health = {},
                                  .on_system_health = [this](const diagnostics::SystemHealth& sample) { take(sample); },
                                  .on_diagnostic_array = {},
                                  .on_presence = {}}};
};

/// A drive without a misaligned radar under the whole product, with all radars verified.
class PipelineVerdict : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(setenv("BORESIGHT_DDS_DOMAIN", kDdsDomain, 1), 0);
    const auto recordings = harness::simulated_drive(kDrive_s, "aligned_drive");
    observer_ = std::make_unique<Observer>("-verdict");
    domain_.start();
    subscriber_ = std::make_unique<Subscriber>();
    ASSERT_TRUE(domain_.until(5.0, [&] { return observer_->is_attached(); }));
    domain_.replay(recordings);
    ASSERT_TRUE(is_available_within(30.0)) << "the radars are not verified";
  }
  void TearDown() override { EXPECT_EQ(observer_->process().stop(), 0); }

  [[nodiscard]] const Sample* latest() const {
    const auto reports = observer_->of(TopicId::kHealthReport, looked_at_);
    return reports.empty() ? nullptr : reports.back();
  }
  [[nodiscard]] bool is_available_within(double seconds) {
    return domain_.until(seconds, [&] {
      const Sample* const report = latest();
      return report != nullptr && report->overall == DataQualifier::kAvailable;
    });
  }
  /// Seconds from `begin_ns` to the first report that `is_reached` accepts; negative without one.
  [[nodiscard]] double seconds_to(std::int64_t begin_ns, const std::function<bool(const Sample&)>& is_reached) const {
    for (const Sample* report : observer_->of(TopicId::kHealthReport, looked_at_)) {
      if (report->received_ns < begin_ns || !is_reached(*report)) continue;
      return static_cast<double>(report->received_ns - begin_ns) * 1e-9;
    }
    return -1.0;
  }
  /// Lets `disturb(pid)` act for about a second; then the verdict must have come in time, and the system recovers.
  template <typename Disturb>
  void expect_verdict(const char* what, const char* service, bool pipeline_must_fail, Disturb disturb) {
    looked_at_ = observer_->size();
    const std::int64_t begin_ns = runtime::monotonic_now_ns();
    disturb(domain_.supervisor().pid_of(service));
    const double overall_s =
        seconds_to(begin_ns, [](const Sample& s) { return s.overall != DataQualifier::kAvailable; });
    const double pipeline_s =
        seconds_to(begin_ns, [](const Sample& s) { return s.pipeline.data_qualifier != DataQualifier::kAvailable; });
    const double topic_s = subscriber_->seconds_to_verdict(begin_ns);
    std::printf("%s: not AVAILABLE after %.3f s, by DDS after %.3f s; pipeline after %.3f s\n", what, overall_s,
                topic_s, pipeline_s);
    for (const double seconds : {overall_s, topic_s}) {
      EXPECT_GT(seconds, 0.0) << what;
      EXPECT_LT(seconds, kVerdict_s) << what;
    }
    // A killed stage may be back before the pipeline is silent.
    if (pipeline_must_fail) {
      EXPECT_GT(pipeline_s, 0.0) << what;
      EXPECT_LT(pipeline_s, kVerdict_s) << what;
    }
    looked_at_ = observer_->size();
    EXPECT_TRUE(is_available_within(kRecovery_s)) << "after: " << what;
  }
  /// The events of the pipeline that any report since the begin of the latest disturbance states.
  [[nodiscard]] std::uint32_t events_since(std::size_t from) const {
    std::uint32_t events = 0;
    for (const Sample* report : observer_->of(TopicId::kHealthReport, from)) events |= report->pipeline.failed_events;
    return events;
  }

  std::unique_ptr<Subscriber> subscriber_;
  harness::Domain domain_{"demo"};
  std::unique_ptr<Observer> observer_;
  std::size_t looked_at_ = 0;
};

[[nodiscard]] std::uint32_t bit(PipelineEvent event) {
  return 1U << static_cast<unsigned>(event);
}

TEST_F(PipelineVerdict, ComesWithinHalfASecondOfAFaultAndNeverWithoutOne) {
  const std::size_t healthy = observer_->size();
  domain_.run_for(kHealthy_s);
  float queueing_max_ms = 0.0F, latency_p99_ms = 0.0F;
  std::size_t flips = 0;
  for (const Sample* report : observer_->of(TopicId::kHealthReport, healthy)) {
    flips += report->overall == DataQualifier::kAvailable ? 0U : 1U;
    queueing_max_ms = std::max(queueing_max_ms, report->pipeline.queueing_max_ms);
    latency_p99_ms = std::max(latency_p99_ms, report->pipeline.latency_p99_ms);
  }
  std::printf("healthy for %.0f s: queueing %.2f ms at most, latency p99 %.2f ms at most\n", kHealthy_s,
              static_cast<double>(queueing_max_ms), static_cast<double>(latency_p99_ms));
  EXPECT_EQ(flips, 0u);
  EXPECT_EQ(events_since(0), 0u) << "no failure since the start";
  EXPECT_GT(queueing_max_ms, 0.0F);
  EXPECT_GT(latency_p99_ms, 0.0F);

  std::size_t begin = observer_->size();
  expect_verdict("slow ghost filter", "ghost_filter", true, [&](pid_t pid) {
    // Gets a third of its time: scans wait for it, and some are superseded.
    for (int i = 0; i < 10; ++i) {
      kill(pid, SIGSTOP);
      domain_.run_for(0.07);
      kill(pid, SIGCONT);
      domain_.run_for(0.03);
    }
  });
  EXPECT_NE(events_since(begin) & bit(PipelineEvent::kQueueing), 0u);
  EXPECT_EQ(events_since(begin) & bit(PipelineEvent::kSilent), 0u);

  begin = observer_->size();
  expect_verdict("tracker stands still", "tracker", true, [&](pid_t pid) {
    kill(pid, SIGSTOP);
    domain_.run_for(0.6);
    kill(pid, SIGCONT);
    domain_.run_for(0.2);
  });
  EXPECT_NE(events_since(begin) & bit(PipelineEvent::kSilent), 0u);

  expect_verdict("detection corrector killed", "detection_corrector", false, [&](pid_t pid) {
    kill(pid, SIGKILL);
    domain_.run_for(1.0);
  });
}

}  // namespace
}  // namespace boresight
