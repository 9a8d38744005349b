#include "services/common/runtime/newest_per_source.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace boresight::runtime {
namespace {

constexpr const MessageHeader* kNone = nullptr;

MessageHeader scan(std::uint32_t radar, std::int64_t measurement_time_ns) {
  MessageHeader header{};
  header.source_id = radar;
  header.measurement_time_ns = measurement_time_ns;
  return header;
}

/// The messages that wait, in the order in which they are handled.
std::vector<const MessageHeader*> taken(NewestPerSource& waiting) {
  std::vector<const MessageHeader*> messages;
  while (const MessageHeader* const next = waiting.take().message) messages.push_back(next);
  return messages;
}

TEST(NewestPerSource, ReturnsASingleMessageAndThenNone) {
  NewestPerSource waiting;
  const MessageHeader only = scan(1, 10);
  EXPECT_EQ(waiting.add(only), kNone);
  const NewestPerSource::Next next = waiting.take();
  EXPECT_EQ(next.message, &only);
  EXPECT_EQ(next.superseded, 0u);
  EXPECT_EQ(waiting.take().message, kNone);
}

TEST(NewestPerSource, KeepsTheNewestOfARadarAndCountsTheOthers) {
  NewestPerSource waiting;
  const MessageHeader first = scan(1, 10), second = scan(1, 20), third = scan(1, 30);
  EXPECT_EQ(waiting.add(first), kNone);
  EXPECT_EQ(waiting.add(second), &first) << "its owner releases it";
  EXPECT_EQ(waiting.add(third), &second);
  const NewestPerSource::Next next = waiting.take();
  EXPECT_EQ(next.message, &third);
  EXPECT_EQ(next.superseded, 2u);
  EXPECT_EQ(waiting.take().message, kNone);
}

TEST(NewestPerSource, OrdersRadarsByMeasurementTimeNotByArrival) {
  NewestPerSource waiting;
  const MessageHeader a = scan(1, 30), b = scan(2, 10), c = scan(3, 20);
  for (const MessageHeader* each : {&a, &b, &c}) static_cast<void>(waiting.add(*each));
  EXPECT_EQ(taken(waiting), (std::vector{&b, &c, &a}));
}

TEST(NewestPerSource, OneRadarDoesNotSupersedeAnother) {
  NewestPerSource waiting;
  const MessageHeader old = scan(2, 10), newer = scan(1, 50), newest = scan(1, 60);
  EXPECT_EQ(waiting.add(old), kNone);
  EXPECT_EQ(waiting.add(newer), kNone);
  EXPECT_EQ(waiting.add(newest), &newer);
  EXPECT_EQ(waiting.take().superseded, 0u) << "radar 2";
  EXPECT_EQ(waiting.take().superseded, 1u) << "radar 1";
}

TEST(NewestPerSource, AScanThatArrivesWhileOthersArePendingSupersedesAPendingOne) {
  NewestPerSource waiting;
  const MessageHeader one = scan(1, 10), two = scan(2, 20), three = scan(3, 30), two_again = scan(2, 70);
  for (const MessageHeader* each : {&one, &two, &three}) static_cast<void>(waiting.add(*each));
  EXPECT_EQ(waiting.take().message, &one);
  EXPECT_EQ(waiting.add(two_again), &two) << "arrived while radar 1's scan was handled";
  EXPECT_EQ(waiting.take().message, &three);
  const NewestPerSource::Next last = waiting.take();
  EXPECT_EQ(last.message, &two_again);
  EXPECT_EQ(last.superseded, 1u);
}

TEST(NewestPerSource, CountStartsAnewWithEachHandledScan) {
  NewestPerSource waiting;
  const MessageHeader a = scan(1, 10), b = scan(1, 20), c = scan(1, 30);
  static_cast<void>(waiting.add(a));
  static_cast<void>(waiting.add(b));
  EXPECT_EQ(waiting.take().superseded, 1u);
  static_cast<void>(waiting.add(c));
  EXPECT_EQ(waiting.take().superseded, 0u);
}

TEST(NewestPerSource, TheLastArrivalIsTheNewestThoughItsClockWentBack) {
  NewestPerSource waiting;
  const MessageHeader before = scan(1, 1000), after = scan(1, 10);
  static_cast<void>(waiting.add(before));
  EXPECT_EQ(waiting.add(after), &before);
  EXPECT_EQ(waiting.take().message, &after);
}

TEST(NewestPerSource, ScansOfBeforeAClockWentBackComeFirst) {
  NewestPerSource waiting;
  const MessageHeader old_one = scan(1, 1000), old_two = scan(2, 1010), new_one = scan(1, 10), new_three = scan(3, 5);
  for (const MessageHeader* each : {&old_one, &old_two, &new_one, &new_three}) static_cast<void>(waiting.add(*each));
  EXPECT_EQ(taken(waiting), (std::vector{&old_two, &new_three, &new_one}));
}

TEST(NewestPerSource, HoldsOneMessageOfEachRadarHoweverManyArrive) {
  NewestPerSource waiting;
  std::vector<MessageHeader> messages;
  for (std::int64_t cycle = 0; cycle < 100; ++cycle) {
    for (std::uint32_t radar = 1; radar <= kMaxRadars; ++radar) messages.push_back(scan(radar, 50 * cycle + radar));
  }
  std::size_t held = 0;
  for (const MessageHeader& each : messages) held += waiting.add(each) == nullptr ? 1 : 0;
  EXPECT_EQ(held, kMaxRadars);
  const auto handled = taken(waiting);
  ASSERT_EQ(handled.size(), kMaxRadars);
  for (std::uint32_t i = 0; i < kMaxRadars; ++i) EXPECT_EQ(handled[i], &messages[99 * kMaxRadars + i]);
}

}  // namespace
}  // namespace boresight::runtime
