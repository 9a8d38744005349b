// kill -9 of RouDi: no service can rejoin a new RouDi, so the supervisor restarts the whole domain within two seconds.
#include <memory>

#include <gtest/gtest.h>
#include <signal.h>

#include "services/common/runtime/clock.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::TopicId;
using harness::Observer;

TEST(RoudiKilled, DomainIsBackWithinTwoSecondsAndDataFlow) {
  const auto recordings = harness::simulated_drive(8.0);
  auto observer = std::make_unique<Observer>("-before");
  harness::Domain domain("demo");
  domain.start();
  domain.replay(recordings);
  ASSERT_TRUE(domain.until(5.0, [&] { return observer->of(TopicId::kClassifiedScan).size() >= 20; }));
  observer.reset();

  const std::int64_t killed_ns = runtime::monotonic_now_ns();
  const pid_t old_roudi = domain.supervisor().roudi_pid();
  ASSERT_EQ(kill(old_roudi, SIGKILL), 0);
  EXPECT_TRUE(
      domain.until(5.0, [&] { return domain.supervisor().domain_restarts() == 1 && domain.supervisor().all_ready(); }));
  const double back_s = static_cast<double>(runtime::monotonic_now_ns() - killed_ns) * 1e-9;
  RecordProperty("back_s", std::to_string(back_s));
  EXPECT_LT(back_s, 2.0);
  EXPECT_NE(domain.supervisor().roudi_pid(), old_roudi);

  Observer after("-after");
  EXPECT_TRUE(domain.until(2.0, [&] { return after.of(TopicId::kClassifiedScan).size() >= 10; }));
  EXPECT_EQ(after.process().stop(), 0);
}

}  // namespace
}  // namespace boresight
