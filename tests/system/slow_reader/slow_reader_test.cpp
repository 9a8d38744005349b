// A monitor that sleeps in every scan loses scans itself and delays no other process.
#include <map>

#include <gtest/gtest.h>

#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::TopicId;
using harness::Observer;
using harness::Sample;

std::size_t gaps(const std::vector<const Sample*>& samples) {
  std::size_t lost = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    lost += samples[i]->header.sequence - samples[i - 1]->header.sequence - 1;
  }
  return lost;
}

TEST(SlowReader, LosesScansItselfAndDelaysNoOther) {
  const auto recordings = harness::simulated_drive(5.0);
  Observer quick("-quick");
  Observer slow("-slow", 0.2);
  harness::Domain domain("demo");
  domain.start();
  ASSERT_TRUE(domain.until(5.0, [&] { return quick.is_attached() && slow.is_attached(); }));
  domain.replay(recordings);
  ASSERT_TRUE(domain.until(15.0, [&] { return domain.replay_has_ended(); }));
  domain.run_for(0.5);
  EXPECT_EQ(quick.process().stop(), 0);
  EXPECT_EQ(slow.process().stop(), 0);

  EXPECT_GT(gaps(slow.of(TopicId::kRadarScan)), 50u) << "it reads 5 of 80 scans a second";
  for (const TopicId topic : {TopicId::kRadarScan, TopicId::kCorrectedScan, TopicId::kClassifiedScan}) {
    const auto samples = quick.of(topic);
    EXPECT_GE(samples.size(), 4 * 98u) << catalogue::topic(topic).name;
    EXPECT_EQ(gaps(samples), 0u) << catalogue::topic(topic).name;
  }
  std::map<std::uint32_t, ServiceStatus> last;
  for (const Sample* sample : quick.of(TopicId::kServiceStatus)) last[sample->header.source_id] = sample->status;
  for (const auto& [service, status] : last) {
    EXPECT_EQ(status.faults[static_cast<std::size_t>(Fault::kInputLost)], 0u) << catalogue::kServiceNames[service];
    EXPECT_EQ(status.faults[static_cast<std::size_t>(Fault::kLoanFailed)], 0u) << catalogue::kServiceNames[service];
  }
}

}  // namespace
}  // namespace boresight
