// The table of topics: consistent, and usable with a request of two seconds.
#include "services/health/dds/topics.hpp"

#include <gtest/gtest.h>

#include "services/health/dds/config.hpp"

namespace boresight::dds {
namespace {

TEST(DdsTopics, AReaderThatRequestsTwoSecondsMatchesThePeriodicTopics) {
  const Config config;
  for (const TopicQos& topic : kTopics) {
    if (topic.deadline_periods == 0.0) continue;
    EXPECT_LE(topic.deadline_periods * config.period_s, 2.0) << topic.name;
    EXPECT_LE(topic.lease_periods * config.period_s, 2.0) << topic.name;
    EXPECT_LT(topic.requested_periods * config.period_s, 2.0) << topic.name << ": ours know within two seconds";
    EXPECT_GT(topic.deadline_periods, 1.0) << topic.name << ": a punctual sender is never late";
  }
}

TEST(DdsTopics, HaveRoomForEveryRadarAndEvent) {
  EXPECT_GE(static_cast<std::size_t>(kSensorHealthTopic.most_instances), kMaxRadars);
  std::size_t events = 0;
  for (const health::EventType& type : health::event_types()) events += health::subjects_of(type.subject);
  EXPECT_GE(static_cast<std::size_t>(kFaultRecordTopic.most_instances), events);
}

}  // namespace
}  // namespace boresight::dds
