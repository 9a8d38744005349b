// The table of topics: consistent, usable with a request of two seconds, and as documented.
#include "services/health/dds/topics.hpp"

#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "services/health/dds/config.hpp"

namespace boresight::dds {
namespace {

std::string periods(double number) {
  return number > 0.0 ? fmt::format("{}", number) : std::string("none");
}

std::string row_of(const TopicQos& topic) {
  return fmt::format("| `{}` | {} | {} | {} | {} | {} | {} | {} | {} KiB |\n", topic.name,
                     topic.durability == Durability::kTransientLocal ? "transient local" : "volatile",
                     topic.written_depth, topic.most_instances, periods(topic.deadline_periods),
                     periods(topic.lease_periods), periods(topic.lifespan_periods), periods(topic.requested_periods),
                     topic.most_bytes / 1024);
}

TEST(DdsTopics, ThePageShowsTheTable) {
  std::ifstream file(std::string(BORESIGHT_SOURCE_DIR) + "/services/health/README.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  std::string table;
  for (const TopicQos& topic : kTopics) table += row_of(topic);
  EXPECT_NE(page.find("requested | largest sample |\n|---|---|---|---|---|---|---|---|---|\n" + table + "\n"),
            std::string::npos)
      << table;
}

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
