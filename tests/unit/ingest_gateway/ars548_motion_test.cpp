#include "services/ingest_gateway/codecs/ars548_motion.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "interfaces/wire/ars548.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest::ars548 {
namespace {

constexpr float kRadian = 3.14159265F / 180.0F;

std::string hex(const MotionDatagram& datagram) {
  std::string text;
  for (const std::uint8_t byte : datagram.payload()) text += fmt::format("{:02x}", byte);
  return text;
}

EgoMotion ego_of(std::uint32_t fields, float speed_mps = 0.0F) {
  EgoMotion ego{};
  ego.fields = fields;
  ego.speed_mps = speed_mps;
  return ego;
}

const MotionDatagram* find(std::span<const MotionDatagram> datagrams, const wire::ars548::MotionInput& input) {
  for (const MotionDatagram& d : datagrams) {
    if (d.bytes[2] == input.method >> 8 && d.bytes[3] == (input.method & 0xFF)) return &d;
  }
  return nullptr;
}

float value_of(const MotionDatagram& datagram, const wire::ars548::MotionInput& input) {
  std::uint32_t raw = 0;
  for (std::size_t i = 0; i < 4; ++i) raw = raw << 8 | datagram.bytes[input.value + i];
  return std::bit_cast<float>(raw);
}

TEST(Ars548Motion, EveryMessageByteForByte) {
  EgoMotion ego =
      ego_of(ego_field::kSpeed | ego_field::kYawRate | ego_field::kSteeringAngle | ego_field::kReverse, -10.0F);
  ego.yaw_rate_radps = -8.0F * kRadian;
  ego.steering_angle_rad = 75.0F * kRadian;
  ego.longitudinal_acceleration_mps2 = 1.5F;
  MotionFeed feed;
  const auto sent = feed.encode(ego, 0);
  ASSERT_EQ(sent.size(), 5u);
  // Service and method, length of the following bytes, reserved, value, reserved.
  const auto zeros = [](std::size_t bytes) { return std::string(2 * bytes, '0'); };
  EXPECT_EQ(hex(sent[0]), "000001430000001c" + zeros(3) + "42100000" + zeros(21)) << "36 km/h";
  EXPECT_EQ(hex(sent[1]), "0000014500000016" + zeros(1) + "02" + zeros(20)) << "backward";
  EXPECT_EQ(hex(sent[2]), "0000014200000020" + zeros(6) + "3fc00000" + zeros(22)) << "1.5 m/s²";
  EXPECT_EQ(hex(sent[3]), "0000014600000020" + zeros(6) + "c1000000" + zeros(22)) << "-8 °/s";
  EXPECT_EQ(hex(sent[4]), "0000014700000020" + zeros(6) + "40a00000" + zeros(22)) << "75° / 15";
}

TEST(Ars548Motion, OnlyWhatIsKnownIsSent) {
  MotionFeed feed;
  EXPECT_EQ(feed.encode(ego_of(0, 10.0F), 0).size(), 0u);
  EXPECT_EQ(feed.encode(ego_of(ego_field::kYawRate), 1).size(), 1u) << "nothing sent, so no period has begun";
  MotionFeed without_ratio(MotionConfig{.steering_ratio = 0.0});
  EXPECT_EQ(without_ratio.encode(ego_of(ego_field::kSteeringAngle), 0).size(), 0u);
  const auto speed = feed.encode(ego_of(ego_field::kSpeed, 10.0F), 100 * kMillisecond);
  EXPECT_EQ(speed.size(), 3u);
  EXPECT_EQ(find(speed, wire::ars548::kYawRate_degps), nullptr);
}

TEST(Ars548Motion, ValuesAreLimitedToTheSensorsRangesAndNonsenseIsNotSent) {
  EgoMotion ego = ego_of(ego_field::kSpeed | ego_field::kYawRate | ego_field::kSteeringAngle, 200.0F);
  ego.yaw_rate_radps = -10.0F;
  ego.steering_angle_rad = 100.0F;
  ego.longitudinal_acceleration_mps2 = 1e6F;
  MotionFeed feed(MotionConfig{.steering_ratio = 1.0});
  const auto sent = feed.encode(ego, 0);
  ASSERT_EQ(sent.size(), 5u);
  EXPECT_EQ(value_of(sent[0], wire::ars548::kSpeed_kmph), 350.0F);
  EXPECT_EQ(value_of(sent[2], wire::ars548::kLongitudinalAcceleration_mps2), 65.0F);
  EXPECT_EQ(value_of(sent[3], wire::ars548::kYawRate_degps), -163.83F);
  EXPECT_EQ(value_of(sent[4], wire::ars548::kSteeringAngle_deg), 90.0F);
  ego.speed_mps = std::numeric_limits<float>::quiet_NaN();
  ego.yaw_rate_radps = std::numeric_limits<float>::infinity();
  const auto rest = feed.encode(ego, 20 * kMillisecond);
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_NE(find(rest, wire::ars548::kSteeringAngle_deg), nullptr);
}

TEST(Ars548Motion, DirectionOfTravel) {
  const auto direction = [](MotionFeed& feed, std::uint32_t fields, float speed_mps, std::int64_t now_ms) {
    const auto sent = feed.encode(ego_of(ego_field::kSpeed | fields, speed_mps), now_ms * kMillisecond);
    return find(sent, wire::ars548::kDrivingDirection)->bytes[wire::ars548::kDrivingDirection.value];
  };
  MotionFeed feed;
  EXPECT_EQ(direction(feed, 0, 0.2F, 0), 0) << "not yet moving";
  EXPECT_EQ(direction(feed, 0, 0.5F, 100), 1);
  EXPECT_EQ(direction(feed, 0, 0.2F, 200), 1) << "still moving";
  EXPECT_EQ(direction(feed, 0, 0.0F, 300), 0);
  EXPECT_EQ(direction(feed, ego_field::kReverse, -2.0F, 400), 2);
  EXPECT_EQ(direction(feed, ego_field::kReverse, 2.0F, 500), 1);
  EXPECT_EQ(direction(feed, 0, -2.0F, 600), 1) << "a sign without kReverse";
  const auto speed = feed.encode(ego_of(ego_field::kSpeed | ego_field::kReverse, -2.5F), 700 * kMillisecond);
  EXPECT_EQ(value_of(speed[0], wire::ars548::kSpeed_kmph), 9.0F) << "without a sign";
}

TEST(Ars548Motion, AtMostFiftyTimesASecond) {
  MotionFeed feed;
  const EgoMotion ego = ego_of(ego_field::kSpeed, 10.0F);
  int rounds = 0;
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting(true);
    for (std::int64_t t = 0; t < 1000 * kMillisecond; t += kMillisecond) rounds += feed.encode(ego, t).empty() ? 0 : 1;
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(rounds, 50);
  EXPECT_EQ(feed.encode(ego, 999 * kMillisecond).size(), 0u);
  EXPECT_EQ(feed.encode(ego, 5 * kMillisecond).size(), 3u) << "still sends after the clock went back";
}

}  // namespace
}  // namespace boresight::ingest::ars548
