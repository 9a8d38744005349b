// The wall clock steps by an hour in both directions, while scans flow and while the radars are silent. No wait of any
// service may depend on it.
#include <cstdlib>
#include <map>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "services/common/runtime/clock.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::Service;
using catalogue::TopicId;
using harness::Observer;
using harness::Sample;
using runtime::monotonic_now_ns;

constexpr std::int64_t kHour_ns = 3'600'000'000'000;
constexpr double kLongestGap_s = 0.5;

/// The offset that processes started later read in place of the true wall clock.
class WallClock {
 public:
  WallClock() : file_(open(kPath, O_CREAT | O_TRUNC | O_RDWR | O_CLOEXEC, 0644)) {
    step_to(0);
    setenv("BORESIGHT_TEST_WALL_CLOCK", kPath, 1);
    setenv("LD_PRELOAD", BORESIGHT_WALL_CLOCK, 1);
  }
  ~WallClock() {
    unsetenv("LD_PRELOAD");
    close(file_);
  }
  void step_to(std::int64_t offset_ns) const {
    EXPECT_EQ(pwrite(file_, &offset_ns, sizeof(offset_ns), 0), static_cast<ssize_t>(sizeof(offset_ns)));
  }

 private:
  static constexpr const char* kPath = "/tmp/wall_clock";
  int file_;
};

/// Longest times without a message between two times, by topic, and for heartbeats by service.
class Gaps {
 public:
  Gaps(const Observer& observer, std::int64_t from_ns, std::int64_t to_ns) : from_ns_(from_ns) {
    for (std::size_t i = 0; i < observer.size(); ++i) {
      const Sample& sample = observer[i];
      if (sample.received_ns < from_ns || sample.received_ns > to_ns) continue;
      note(name_of(sample), sample.received_ns);
    }
    for (auto& [name, gap] : gaps_) note(name, to_ns);
  }
  [[nodiscard]] double longest_s(const std::string& name) const {
    const auto found = gaps_.find(name);
    return found == gaps_.end() ? 1e9 : 1e-9 * static_cast<double>(found->second.longest_ns);
  }

 private:
  struct Gap {
    std::int64_t last_ns;
    std::int64_t longest_ns;
  };
  static std::string name_of(const Sample& sample) {
    if (sample.topic == TopicId::kServiceStatus)
      return std::string(catalogue::name_of(static_cast<Service>(sample.header.source_id)));
    return std::string(catalogue::topic(sample.topic).name);
  }
  void note(const std::string& name, std::int64_t now_ns) {
    Gap& gap = gaps_.try_emplace(name, Gap{from_ns_, 0}).first->second;
    gap.longest_ns = std::max(gap.longest_ns, now_ns - std::exchange(gap.last_ns, now_ns));
  }

  std::int64_t from_ns_;
  std::map<std::string, Gap> gaps_;
};

void expect_no_gap_of_services(const Gaps& gaps) {
  for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
    const std::string name(catalogue::kServiceNames[i]);
    EXPECT_LT(gaps.longest_s(name), kLongestGap_s) << "heartbeat of " << name;
  }
  EXPECT_LT(gaps.longest_s("health_report"), kLongestGap_s);
}

TEST(ClockStep, DelaysNoOutputOfAnyService) {
#ifdef BORESIGHT_SANITIZED
  GTEST_SKIP() << "sanitizers must be loaded before any other library";
#endif
  const auto recordings = harness::simulated_drive(10.0);
  Observer observer("-clock-step");
  const WallClock clock;
  harness::Domain domain("demo");
  domain.start();
  domain.replay(recordings);
  ASSERT_TRUE(domain.until(5.0, [&] { return observer.of(TopicId::kTrackList).size() >= 20; }));

  const std::int64_t flow_begin_ns = monotonic_now_ns();
  for (const std::int64_t offset_ns : {kHour_ns, std::int64_t{0}, -kHour_ns, std::int64_t{0}}) {
    domain.run_for(1.0);
    clock.step_to(offset_ns);
  }
  domain.run_for(1.0);
  const Gaps in_flow(observer, flow_begin_ns, monotonic_now_ns());
  expect_no_gap_of_services(in_flow);
  for (const char* const topic :
       {"radar_scan", "ego_motion", "alignment_estimate", "corrected_scan", "classified_scan", "track_list"}) {
    EXPECT_LT(in_flow.longest_s(topic), kLongestGap_s) << topic;
  }

  ASSERT_TRUE(domain.until(20.0, [&] { return domain.replay_has_ended(); }));
  const std::int64_t silence_begin_ns = monotonic_now_ns();
  for (const std::int64_t offset_ns : {-kHour_ns, std::int64_t{0}, kHour_ns, std::int64_t{0}}) {
    domain.run_for(1.0);
    clock.step_to(offset_ns);
  }
  domain.run_for(1.0);
  expect_no_gap_of_services(Gaps(observer, silence_begin_ns, monotonic_now_ns()));

  // Registration and discovery go on as well: a service that is restarted after the step gets its inputs.
  clock.step_to(-kHour_ns);
  domain.run_for(0.5);
  const pid_t tracker = domain.supervisor().pid_of("tracker");
  kill(tracker, SIGTERM);
  EXPECT_TRUE(domain.until(
      3.0, [&] { return domain.supervisor().pid_of("tracker") != tracker && domain.supervisor().all_ready(); }));
  const std::size_t before = observer.size();
  domain.replay(recordings);
  EXPECT_TRUE(domain.until(5.0, [&] { return observer.of(TopicId::kTrackList, before).size() >= 20; }));
  EXPECT_EQ(domain.supervisor().domain_restarts(), 0);
}

}  // namespace
}  // namespace boresight
