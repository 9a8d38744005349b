// A member of the domain is killed within publish(). Its successor's registration then stops RouDi for ever. The domain
// is back, and data flow, within two seconds of the kill.
#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "services/common/runtime/clock.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::TopicId;
using harness::Observer;

constexpr double kLimit_s = 2.0;

/// Dead mutexes to provoke; more of them with DEAD_MUTEXES=N measure the distribution.
int wanted_dead_mutexes() {
  const char* const text = std::getenv("DEAD_MUTEXES");
  return text == nullptr ? 2 : std::atoi(text);
}

std::string last_restart(const supervisor::Supervisor& supervisor) {
  std::string reason;
  for (const supervisor::Event& event : supervisor.events()) {
    if (event.kind == supervisor::EventKind::kDomainRestart) reason = event.detail;
  }
  return reason;
}

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

TEST(DeadMutex, DomainIsBackWithinTwoSecondsOfTheKill) {
  const auto recordings = harness::simulated_drive(8.0);
  supervisor::ProcessSpec restless{.name = "restless",
                                   .command = {.arguments = {RESTLESS_PUBLISHER}, .environment = {}},
                                   .runtime_name = "boresight-restless"};
  restless.is_on_data_path = false;
  harness::Domain domain("demo", {}, harness::shipped_configuration(), {restless});
  supervisor::Supervisor& supervisor = domain.supervisor();
  domain.start();
  domain.replay(recordings, {"--loop", "1000"});

  int dead_mutexes = 0;
  for (int kills = 0; dead_mutexes < wanted_dead_mutexes() && kills < 20 * wanted_dead_mutexes(); ++kills) {
    domain.run_for(0.3);
    const std::uint32_t restarts = supervisor.domain_restarts();
    const std::int64_t killed_ns = runtime::monotonic_now_ns();
    ASSERT_EQ(kill(supervisor.pid_of("restless"), SIGKILL), 0);
    // Registered again without a dead mutex: another kill.
    if (!domain.until(1.5, [&] { return supervisor.domain_restarts() > restarts; })) {
      ASSERT_TRUE(domain.until(5.0, [&] { return supervisor.all_ready(); }));
      continue;
    }
    ++dead_mutexes;
    ASSERT_TRUE(domain.until(10.0, [&] { return supervisor.all_ready(); }));
    const double ready_s = seconds_between(killed_ns, runtime::monotonic_now_ns());
    EXPECT_LT(ready_s, kLimit_s);
    EXPECT_EQ(supervisor.domain_restarts(), restarts + 1);
    EXPECT_THAT(last_restart(supervisor), ::testing::HasSubstr("waits for a mutex of an ended process"));
    Observer observer("-" + std::to_string(kills));
    ASSERT_TRUE(domain.until(5.0, [&] { return !observer.of(TopicId::kClassifiedScan).empty(); }));
    const double data_s = seconds_between(killed_ns, observer.of(TopicId::kClassifiedScan).front()->received_ns);
    std::printf("kill %d: domain ready after %.3f s, data after %.3f s\n", kills, ready_s, data_s);
    EXPECT_EQ(observer.process().stop(), 0);
  }
  EXPECT_EQ(dead_mutexes, wanted_dead_mutexes()) << "no kill hit a publication";
}

}  // namespace
}  // namespace boresight
