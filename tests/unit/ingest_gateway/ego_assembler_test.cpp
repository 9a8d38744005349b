#include "services/ingest_gateway/core/ego_assembler.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

FrameStamp at(std::int64_t time_ns) {
  return {time_ns, 0, TimeSource::kLinkArrival};
}

EgoReading speed(double mps, bool is_signed = false) {
  EgoReading reading;
  reading.speed_mps = mps;
  reading.speed_is_signed = is_signed;
  return reading;
}

EgoReading gear(bool reverse) {
  EgoReading reading;
  reading.reverse = reverse;
  return reading;
}

EgoReading everything(double speed_mps, double yaw_rate_radps, double steering_rad) {
  EgoReading reading;
  reading.speed_mps = speed_mps;
  reading.yaw_rate_radps = yaw_rate_radps;
  reading.steering_angle_rad = steering_rad;
  return reading;
}

EgoMotion motion(const EgoAssembler& ego) {
  EgoMotion out;
  std::memset(static_cast<void*>(&out), 0xA5, sizeof out);  // a loaned chunk holds old data
  ego.write(out);
  return out;
}

TEST(EgoAssembler, ASpeedCompletesAMotionOfItsOwnTime) {
  EgoConfig config;
  config.speed_std_mps = 0.03;
  config.yaw_rate_std_radps = 0.003;
  config.steering_angle_std_rad = 0.02;
  EgoAssembler ego(config);
  EgoReading turning;
  turning.yaw_rate_radps = 0.2;
  turning.steering_angle_rad = -0.5;
  EXPECT_FALSE(ego.take(turning, at(10 * kMillisecond)).complete);
  const auto result = ego.take(speed(12.0), {30 * kMillisecond, 5, TimeSource::kUserArrival});
  EXPECT_TRUE(result.complete);
  EXPECT_TRUE(result.rejected.empty());
  EXPECT_EQ(ego.time().time_ns, 30 * kMillisecond);
  EXPECT_EQ(ego.time().source, TimeSource::kUserArrival);
  const EgoMotion out = motion(ego);
  EXPECT_EQ(out.fields, ego_field::kSpeed | ego_field::kYawRate | ego_field::kSteeringAngle);
  EXPECT_FLOAT_EQ(out.speed_mps, 12.0F);
  EXPECT_FLOAT_EQ(out.yaw_rate_radps, 0.2F);
  EXPECT_FLOAT_EQ(out.steering_angle_rad, -0.5F);
  EXPECT_FLOAT_EQ(out.speed_std_mps, 0.03F);
  EXPECT_FLOAT_EQ(out.yaw_rate_std_radps, 0.003F);
  EXPECT_FLOAT_EQ(out.steering_angle_std_rad, 0.02F);
  EXPECT_EQ(out.longitudinal_acceleration_mps2, 0.0F);
}

TEST(EgoAssembler, NoMotionIsCompleteBeforeTheFirstSpeed) {
  EgoAssembler ego(EgoConfig{});
  EXPECT_FALSE(ego.take({}, at(0)).complete);
  EXPECT_FALSE(ego.take(gear(true), at(0)).complete);
  EXPECT_EQ(motion(ego).fields, 0u);
}

TEST(EgoAssembler, OldSignalsAreMissingInFieldsAndZero) {
  EgoAssembler ego(EgoConfig{});
  ASSERT_TRUE(ego.take(everything(10.0, 0.1, 0.2), at(0)).complete);
  ASSERT_TRUE(ego.take(speed(10.0), at(200 * kMillisecond)).complete);
  EXPECT_EQ(motion(ego).fields, ego_field::kSpeed | ego_field::kYawRate | ego_field::kSteeringAngle);
  ASSERT_TRUE(ego.take(speed(10.0), at(201 * kMillisecond)).complete);
  const EgoMotion out = motion(ego);
  EXPECT_EQ(out.fields, ego_field::kSpeed);
  EXPECT_EQ(out.yaw_rate_radps, 0.0F);
  EXPECT_EQ(out.steering_angle_rad, 0.0F);
}

TEST(EgoAssembler, ImpossibleSignalsAreRejectedWithAReasonAndTheOthersUsed) {
  const std::vector<double> impossible = {kNan, kInfinity, -kInfinity, 1e300};
  for (const double bad : impossible) {
    EgoAssembler ego(EgoConfig{});
    auto result = ego.take(everything(10.0, bad, 0.2), at(0));
    EXPECT_TRUE(result.complete);
    EXPECT_NE(result.rejected.find("yaw rate"), std::string_view::npos);
    EXPECT_EQ(motion(ego).fields, ego_field::kSpeed | ego_field::kSteeringAngle);
    result = ego.take(everything(10.0, 0.1, bad), at(kMillisecond));
    EXPECT_TRUE(result.complete);
    EXPECT_NE(result.rejected.find("steering"), std::string_view::npos);
    EXPECT_FLOAT_EQ(motion(ego).steering_angle_rad, 0.2F) << "the previous one";
    result = ego.take(everything(bad, 0.15, 0.3), at(2 * kMillisecond));
    EXPECT_FALSE(result.complete);
    EXPECT_NE(result.rejected.find("speed"), std::string_view::npos);
    EXPECT_FLOAT_EQ(motion(ego).speed_mps, 10.0F);
    EXPECT_FLOAT_EQ(motion(ego).yaw_rate_radps, 0.15F);
  }
}

TEST(EgoAssembler, LimitsAreExact) {
  const auto takes = [](const EgoReading& reading) {
    EgoAssembler ego(EgoConfig{});
    return ego.take(reading, at(0)).rejected.empty();
  };
  EXPECT_TRUE(takes(speed(100.0)));
  EXPECT_FALSE(takes(speed(100.01)));
  EXPECT_TRUE(takes(speed(-30.0, true)));
  EXPECT_FALSE(takes(speed(-30.01, true)));
  EXPECT_TRUE(takes(everything(0.0, -2.99, 20.0)));
  EXPECT_FALSE(takes(everything(0.0, -3.0, 0.0)));
  EXPECT_FALSE(takes(everything(0.0, 0.0, -20.01)));
}

TEST(EgoAssembler, ASpikeIsRejectedAndANewLevelIsAcceptedWithTheThirdReading) {
  EgoAssembler ego(EgoConfig{});
  std::int64_t t = 0;
  const auto take = [&](double v) { return ego.take(speed(v), at(t += 20 * kMillisecond)); };
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(take(20.0).complete);
  EXPECT_NE(take(25.0).rejected.find("30 m/s²"), std::string_view::npos);
  EXPECT_TRUE(take(20.1).complete) << "a single spike";
  EXPECT_FALSE(take(25.0).complete);
  EXPECT_FALSE(take(35.0).complete);
  EXPECT_FALSE(take(5.0).complete) << "different spikes are no new level";
  EXPECT_TRUE(take(20.2).complete);
  EXPECT_FALSE(take(25.0).complete);
  EXPECT_FALSE(take(25.1).complete);
  EXPECT_FLOAT_EQ(motion(ego).speed_mps, 20.2F);
  EXPECT_TRUE(take(25.2).complete);
  EXPECT_FLOAT_EQ(motion(ego).speed_mps, 25.2F);
  EXPECT_EQ(motion(ego).longitudinal_acceleration_mps2, 0.0F) << "a step is no acceleration";
  EXPECT_TRUE(take(25.2).complete);
}

TEST(EgoAssembler, AfterASilenceAnySpeedIsAccepted) {
  EgoAssembler ego(EgoConfig{});
  ASSERT_TRUE(ego.take(speed(20.0), at(0)).complete);
  EXPECT_FALSE(ego.take(speed(5.0), at(200 * kMillisecond)).complete);
  EXPECT_TRUE(ego.take(speed(5.0), at(201 * kMillisecond)).complete);
  EXPECT_EQ(motion(ego).longitudinal_acceleration_mps2, 0.0F);
}

TEST(EgoAssembler, HardBrakingWithJitteringArrivalIsNeverRejected) {
  // 12 m/s² from 40 m/s at 80 Hz; frames queue for up to 12 ms, so that two may arrive at the same time.
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::int64_t> wait_ns(0, 12 * kMillisecond);
  for (int run = 0; run < 50; ++run) {
    EgoAssembler ego(EgoConfig{});
    std::int64_t last_ns = 0;
    for (int i = 0; i < 260; ++i) {
      const double v = 40.0 - 12.0 * 0.0125 * i;
      last_ns = std::max<std::int64_t>(last_ns, i * 12'500'000LL + wait_ns(random));
      const auto result = ego.take(speed(v), at(last_ns));
      ASSERT_TRUE(result.complete) << run << ' ' << i << ' ' << result.rejected;
      ASSERT_LT(std::abs(motion(ego).longitudinal_acceleration_mps2), 40.0F);
    }
    EXPECT_NEAR(motion(ego).longitudinal_acceleration_mps2, -12.0F, 6.0F);
  }
}

TEST(EgoAssembler, ASpeedJumpOnABumpIsNoFault) {
  // From a recorded drive, 11 … 16 ms apart.
  EgoAssembler ego(EgoConfig{});
  std::int64_t t = 0;
  for (const double v : {15.66, 16.50, 16.59, 15.79, 15.36, 15.98, 16.23, 15.68, 15.21, 14.59, 15.00}) {
    EXPECT_TRUE(ego.take(speed(v), at(t += 11 * kMillisecond)).complete) << v;
  }
}

TEST(EgoAssembler, DirectionIsInTheSignOnlyIfItIsKnown) {
  EgoAssembler ego(EgoConfig{});
  ASSERT_TRUE(ego.take(speed(1.5), at(0)).complete);
  EXPECT_EQ(motion(ego).fields, ego_field::kSpeed);
  // By gear.
  static_cast<void>(ego.take(gear(true), at(10 * kMillisecond)));
  ASSERT_TRUE(ego.take(speed(1.5), at(20 * kMillisecond)).complete) << "the sign of the gear is no step in speed";
  EXPECT_EQ(motion(ego).fields, ego_field::kSpeed | ego_field::kReverse);
  EXPECT_FLOAT_EQ(motion(ego).speed_mps, -1.5F);
  EXPECT_EQ(motion(ego).longitudinal_acceleration_mps2, 0.0F);
  ASSERT_TRUE(ego.take(speed(1.6), at(40 * kMillisecond)).complete);
  EXPECT_LT(motion(ego).longitudinal_acceleration_mps2, 0.0F) << "faster backwards";
  static_cast<void>(ego.take(gear(false), at(50 * kMillisecond)));
  ASSERT_TRUE(ego.take(speed(1.5), at(60 * kMillisecond)).complete);
  EXPECT_FLOAT_EQ(motion(ego).speed_mps, 1.5F);
  EXPECT_TRUE(motion(ego).has(ego_field::kReverse)) << "forward is known as well";
  // Without further gear signals the direction is unknown.
  for (std::int64_t t = 160; t <= 1560; t += 100) ASSERT_TRUE(ego.take(speed(1.5), at(t * kMillisecond)).complete);
  EXPECT_FALSE(motion(ego).has(ego_field::kReverse));
  // By a signed speed.
  ASSERT_TRUE(ego.take(speed(-2.0, true), at(3000 * kMillisecond)).complete);
  EXPECT_TRUE(motion(ego).has(ego_field::kReverse));
  EXPECT_FLOAT_EQ(motion(ego).speed_mps, -2.0F);
}

TEST(EgoAssembler, StandingStillIsAMotionToo) {
  EgoAssembler ego(EgoConfig{});
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(ego.take(everything(0.0, 0.0, 0.0), at(i * 20 * kMillisecond)).complete);
  const EgoMotion out = motion(ego);
  EXPECT_TRUE(out.has(ego_field::kSpeed | ego_field::kYawRate | ego_field::kSteeringAngle));
  EXPECT_EQ(out.speed_mps, 0.0F);
  EXPECT_EQ(out.longitudinal_acceleration_mps2, 0.0F);
}

TEST(EgoAssembler, AClockThatGoesBackIsReportedAndDropsOldSignals) {
  EgoAssembler ego(EgoConfig{});
  ASSERT_TRUE(ego.take(everything(10.0, 0.1, 0.2), at(5'000 * kMillisecond)).complete);
  // A small step back: a reading overtook another one.
  auto result = ego.take(speed(10.0), at(4'950 * kMillisecond));
  EXPECT_FALSE(result.complete);
  EXPECT_FALSE(result.time_jumped);
  EXPECT_FALSE(result.rejected.empty());
  // A large step back: another recording.
  result = ego.take(speed(30.0), at(4'700 * kMillisecond));
  EXPECT_TRUE(result.time_jumped);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(motion(ego).fields, ego_field::kSpeed);
  EXPECT_FALSE(ego.take(speed(30.0), at(4'720 * kMillisecond)).time_jumped);
}

TEST(EgoAssembler, RandomReadingsNeitherAllocateNorGiveImplausibleMotions) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> wild(-200.0, 200.0);
  EgoAssembler ego(EgoConfig{});
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    std::int64_t t = 0;
    for (int i = 0; i < 100'000; ++i) {
      const std::uint64_t dice = random();
      EgoReading reading;
      if (dice & 1u) reading.speed_mps = dice & 2u ? wild(random) : kNan;
      if (dice & 4u) reading.yaw_rate_radps = dice & 8u ? wild(random) : kInfinity;
      if (dice & 16u) reading.steering_angle_rad = wild(random);
      if (dice & 32u) reading.reverse = (dice & 64u) != 0;
      reading.speed_is_signed = (dice & 128u) != 0;
      t += static_cast<std::int64_t>(dice >> 8 & 0xFFFFFFu) - 2'000'000;
      static_cast<void>(ego.take(reading, at(t)));
      const EgoMotion out = motion(ego);
      ASSERT_LE(std::abs(out.speed_mps), 100.0F);
      ASSERT_LE(std::abs(out.yaw_rate_radps), 3.0F);
      ASSERT_LE(std::abs(out.steering_angle_rad), 20.0F);
      ASSERT_TRUE(std::isfinite(out.longitudinal_acceleration_mps2));
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::ingest
