#include "services/ingest_gateway/core/sensor_clock.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kCycle_ns = 50 * kMillisecond;
/// The ECU's epoch clock: November 2026.
constexpr std::int64_t kEpoch_ns = 1'795'000'000 * kSecond;

RadarConfig radar(double latency_s = 0.02) {
  RadarConfig config;
  config.latency_s = latency_s;
  return config;
}

FrameStamp received(std::int64_t time_ns) {
  return {time_ns, kEpoch_ns, TimeSource::kLinkArrival};
}

SensorStamp synchronised(std::int64_t measured_ns) {
  return {kEpoch_ns + measured_ns, true};
}

/// A sensor with its own clock and a link with delays.
struct World {
  double drift = 0.0;
  std::int64_t sensor_start_ns = 7 * kSecond;  // its clock at time 0
  std::int64_t latency_ns = 20 * kMillisecond;
  std::int64_t jitter_ns = 8 * kMillisecond;
  double hiccup_share = 0.01;
  std::mt19937_64 random{1};
  std::int64_t last_received_ns = 0;

  [[nodiscard]] SensorStamp stamp(std::int64_t measured_ns) const {
    return {sensor_start_ns + measured_ns + std::llround(drift * static_cast<double>(measured_ns)), false};
  }
  FrameStamp reception(std::int64_t measured_ns) {
    std::int64_t delay_ns = latency_ns + std::uniform_int_distribution<std::int64_t>(0, jitter_ns)(random);
    if (std::bernoulli_distribution(hiccup_share)(random)) delay_ns += 150 * kMillisecond;
    last_received_ns = std::max(last_received_ns + 1, measured_ns + delay_ns);
    return received(last_received_ns);
  }
};

TEST(SensorClock, WithoutAStampItIsReceptionLessLatency) {
  SensorClock clock(radar(0.075));
  for (int i = 1; i < 50; ++i) {
    const auto result = clock.map(std::nullopt, received(i * kCycle_ns));
    EXPECT_EQ(result.time.time_ns, i * kCycle_ns - 75 * kMillisecond);
    EXPECT_EQ(result.time.source, TimeSource::kLinkArrival);
    EXPECT_FALSE(result.clock_jumped || result.sensor_reset || result.sync_lost);
  }
  SensorClock other(radar());
  EXPECT_EQ(other.map(std::nullopt, {5, 0, TimeSource::kUserArrival}).time.source, TimeSource::kUserArrival);
}

TEST(SensorClock, ASynchronisedStampIsUsedUnchanged) {
  // 247 ms as in a recording of an ARS548.
  for (const std::int64_t delay_ns : {-5 * kMillisecond, 0 * kMillisecond, 247 * kMillisecond, 1000 * kMillisecond}) {
    SensorClock clock(radar());
    const auto result = clock.map(synchronised(10 * kSecond - delay_ns), received(10 * kSecond));
    EXPECT_EQ(result.time.time_ns, 10 * kSecond - delay_ns);
    EXPECT_EQ(result.time.source, TimeSource::kSensorSynchronised);
    EXPECT_FALSE(result.clock_jumped || result.sensor_reset || result.sync_lost);
  }
}

TEST(SensorClock, AnImplausibleSynchronisedStampIsNotUsedAndReportedOnce) {
  for (const std::int64_t delay_ns : {-6 * kMillisecond, 1001 * kMillisecond, -3600 * kSecond, 3600 * kSecond}) {
    SensorClock clock(radar());
    auto result = clock.map(synchronised(10 * kSecond - delay_ns), received(10 * kSecond));
    EXPECT_EQ(result.time.time_ns, 10 * kSecond - 20 * kMillisecond);
    EXPECT_EQ(result.time.source, TimeSource::kLinkArrival);
    EXPECT_TRUE(result.sync_lost);
    result = clock.map(synchronised(10 * kSecond + kCycle_ns - delay_ns), received(10 * kSecond + kCycle_ns));
    EXPECT_FALSE(result.sync_lost);
  }
}

TEST(SensorClock, JitterOfArrivalDoesNotAppearInFreeRunningStamps) {
  double worst_spacing_us = 0.0, worst_error_ms = 0.0;
  for (const double drift : {-100e-6, -30e-6, 0.0, 50e-6, 100e-6}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      World world{.drift = drift, .random = std::mt19937_64(seed)};
      SensorClock clock(radar());
      std::int64_t last_ns = 0;
      for (int i = 1; i <= 20 * 120; ++i) {
        const std::int64_t measured_ns = i * kCycle_ns;
        const auto result = clock.map(world.stamp(measured_ns), world.reception(measured_ns));
        ASSERT_FALSE(result.clock_jumped || result.sensor_reset || result.sync_lost)
            << drift << ' ' << seed << ' ' << i;
        ASSERT_GT(result.time.time_ns, last_ns);
        if (i > 10) {
          ASSERT_EQ(result.time.source, TimeSource::kSensorFreeRunning);
        }
        if (i > 20 * 3) {
          const double spacing_ns = static_cast<double>(result.time.time_ns - last_ns - kCycle_ns);
          worst_spacing_us = std::max(worst_spacing_us, std::abs(spacing_ns) * 1e-3);
        }
        if (i > 20 * 15) {
          const double error_ns = static_cast<double>(result.time.time_ns - measured_ns);
          worst_error_ms = std::max(worst_error_ms, std::abs(error_ns) * 1e-6);
        }
        last_ns = result.time.time_ns;
      }
    }
  }
  std::printf("jitter 0 … 8 ms and hiccups of 150 ms: spacing off by %.1f µs, time off by %.3f ms at most\n",
              worst_spacing_us, worst_error_ms);
  EXPECT_LT(worst_spacing_us, 31.0) << "500 ppm of a cycle, and drift";
  EXPECT_LT(worst_error_ms, 0.8);
}

TEST(SensorClock, AJumpAheadIsReportedOnceAndTheOffsetIsEstimatedAgain) {
  for (const std::int64_t jump_ns : {30 * kMillisecond, 500 * kMillisecond, 3600 * kSecond}) {
    World world{.jitter_ns = 4 * kMillisecond, .hiccup_share = 0.0};
    SensorClock clock(radar());
    unsigned jumps = 0;
    for (int i = 1; i <= 400; ++i) {
      if (i == 200) world.sensor_start_ns += jump_ns;
      const std::int64_t measured_ns = i * kCycle_ns;
      const auto result = clock.map(world.stamp(measured_ns), world.reception(measured_ns));
      jumps += result.clock_jumped;
      EXPECT_FALSE(result.sensor_reset);
      EXPECT_EQ(result.clock_jumped, i == 200) << i;
      EXPECT_NEAR(static_cast<double>(result.time.time_ns - measured_ns), 0.0, 5e6) << i;
      const bool begins = i <= 8 || (i >= 200 && i < 208);
      EXPECT_EQ(result.time.source, begins ? TimeSource::kLinkArrival : TimeSource::kSensorFreeRunning) << i;
    }
    EXPECT_EQ(jumps, 1u);
  }
}

TEST(SensorClock, AJumpBackIsReportedOnce) {
  // A jump of less than a cycle looks like a delay until it persists.
  for (const std::int64_t jump_ns : {40 * kMillisecond, 70 * kMillisecond, 3 * kSecond}) {
    World world{.sensor_start_ns = 3600 * kSecond, .jitter_ns = 4 * kMillisecond, .hiccup_share = 0.0};
    SensorClock clock(radar());
    unsigned jumps = 0;
    for (int i = 1; i <= 400; ++i) {
      if (i == 200) world.sensor_start_ns -= jump_ns;
      const std::int64_t measured_ns = i * kCycle_ns;
      const auto result = clock.map(world.stamp(measured_ns), world.reception(measured_ns));
      jumps += result.clock_jumped;
      EXPECT_FALSE(result.sensor_reset);
      if (i > 245) {
        EXPECT_NEAR(static_cast<double>(result.time.time_ns - measured_ns), 0.0, 5e6) << i;
      }
    }
    EXPECT_EQ(jumps, 1u) << jump_ns;
  }
}

TEST(SensorClock, ARestartedSensorIsReportedAndTimeNeverGoesBack) {
  World world{.sensor_start_ns = 1000 * kSecond, .hiccup_share = 0.0};
  SensorClock clock(radar());
  std::int64_t last_ns = 0;
  for (int i = 1; i <= 300; ++i) {
    const std::int64_t measured_ns = i * kCycle_ns;
    if (i == 150) world.sensor_start_ns = -measured_ns + 2 * kSecond;
    const auto result = clock.map(world.stamp(measured_ns), world.reception(measured_ns));
    EXPECT_EQ(result.sensor_reset, i == 150) << i;
    EXPECT_FALSE(result.clock_jumped);
    EXPECT_GE(result.time.time_ns, last_ns);
    last_ns = result.time.time_ns;
  }
}

TEST(SensorClock, AStoppedClockIsReportedOnceAndThenNotUsed) {
  World world{.jitter_ns = kMillisecond, .hiccup_share = 0.0};
  SensorClock clock(radar());
  unsigned jumps = 0;
  for (int i = 1; i <= 400; ++i) {
    const std::int64_t measured_ns = i * kCycle_ns;
    const auto result = clock.map(world.stamp(std::min(i, 200) * kCycle_ns), world.reception(measured_ns));
    jumps += result.clock_jumped;
    if (i > 222) {
      EXPECT_EQ(result.time.source, TimeSource::kLinkArrival) << i;
      EXPECT_NEAR(static_cast<double>(result.time.time_ns - measured_ns), 0.0, 2e6) << i;
    }
  }
  EXPECT_EQ(jumps, 1u);
}

TEST(SensorClock, AClockWithAWrongUnitIsNeverUsed) {
  SensorClock clock(radar());
  for (int i = 1; i <= 400; ++i) {
    const auto result = clock.map(SensorStamp{i * kCycle_ns / 1000, false}, received(i * kCycle_ns));
    EXPECT_EQ(result.time.source, TimeSource::kLinkArrival) << i;
  }
}

TEST(SensorClock, LossOfSynchronisationDoesNotShiftTheTimes) {
  // The delay of 247 ms is not configured; it was measured while the clock was synchronised.
  std::mt19937_64 random(3);
  std::uniform_int_distribution<std::int64_t> jitter_ns(0, 5 * kMillisecond);
  SensorClock clock(radar(0.0));
  for (int i = 1; i <= 600; ++i) {
    const std::int64_t measured_ns = i * kCycle_ns;
    const bool in_sync = i < 300 || i > 500;
    const SensorStamp stamp{kEpoch_ns + measured_ns, in_sync};
    const auto result = clock.map(stamp, received(measured_ns + 247 * kMillisecond + jitter_ns(random)));
    EXPECT_EQ(result.sync_lost, i == 300) << i;
    EXPECT_FALSE(result.clock_jumped);
    EXPECT_EQ(result.time.source, in_sync ? TimeSource::kSensorSynchronised : TimeSource::kSensorFreeRunning);
    EXPECT_NEAR(static_cast<double>(result.time.time_ns - measured_ns), 0.0, 0.2e6) << i;
  }
  // Without stamps: reception minus the measured delay of this sensor.
  const auto result = clock.map(std::nullopt, received(40 * kSecond));
  EXPECT_EQ(result.time.source, TimeSource::kLinkArrival);
  EXPECT_NEAR(static_cast<double>(result.time.time_ns), 40e9 - 247e6, 0.2e6);
}

TEST(SensorClock, GainingSynchronisationIsNoFault) {
  SensorClock clock(radar());
  for (int i = 1; i <= 200; ++i) {
    const std::int64_t measured_ns = i * kCycle_ns;
    const SensorStamp stamp = i < 100 ? SensorStamp{measured_ns, false} : synchronised(measured_ns);
    const auto result = clock.map(stamp, received(measured_ns + 20 * kMillisecond));
    EXPECT_FALSE(result.clock_jumped || result.sensor_reset || result.sync_lost) << i;
    EXPECT_EQ(result.time.time_ns, measured_ns);
  }
}

TEST(SensorClock, ASynchronisedClockThatGoesBackIsReportedAndHeld) {
  SensorClock clock(radar());
  static_cast<void>(clock.map(synchronised(9'950 * kMillisecond), received(10'000 * kMillisecond)));
  auto result = clock.map(synchronised(9'900 * kMillisecond), received(10'050 * kMillisecond));
  EXPECT_TRUE(result.clock_jumped);
  EXPECT_EQ(result.time.time_ns, 9'950 * kMillisecond);
  result = clock.map(synchronised(9'960 * kMillisecond), received(10'100 * kMillisecond));
  EXPECT_FALSE(result.clock_jumped);
  EXPECT_EQ(result.time.time_ns, 9'960 * kMillisecond);
}

TEST(SensorClock, FramesOfAnEarlierTimeAreReportedAndFollowed) {
  SensorClock clock(radar(0.0));
  static_cast<void>(clock.map(std::nullopt, received(100 * kSecond)));
  auto result = clock.map(std::nullopt, received(5 * kSecond));
  EXPECT_TRUE(result.clock_jumped);
  EXPECT_EQ(result.time.time_ns, 5 * kSecond);
  result = clock.map(std::nullopt, received(5 * kSecond + kCycle_ns));
  EXPECT_FALSE(result.clock_jumped);
}

TEST(SensorClock, RandomStampsNeitherTurnTimeBackSilentlyNorAllocate) {
  std::mt19937_64 random(5);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    SensorClock clock(radar());
    std::int64_t now_ns = 1000 * kSecond, last_ns = INT64_MIN;
    for (int i = 0; i < 200'000; ++i) {
      const std::uint64_t dice = random();
      now_ns += static_cast<std::int64_t>(dice % (100 * kMillisecond));
      std::optional<SensorStamp> stamp;
      switch (dice >> 60) {
        case 0:
          break;
        case 1:
          stamp = SensorStamp{static_cast<std::int64_t>(random()), (dice >> 59 & 1u) != 0};
          break;
        case 2:
          stamp = SensorStamp{INT64_MAX - static_cast<std::int64_t>(random() & 1u), true};
          break;
        case 3:
          stamp = SensorStamp{INT64_MIN, (dice >> 59 & 1u) != 0};
          break;
        case 4:
        case 5:
          stamp = synchronised(now_ns - static_cast<std::int64_t>(random() % (2 * kSecond)));
          break;
        default:
          stamp = SensorStamp{now_ns - 20 * kMillisecond, false};
      }
      const auto result = clock.map(stamp, received(now_ns));
      if (result.time.time_ns < last_ns) {
        ASSERT_TRUE(result.clock_jumped);
      }
      ASSERT_LE(result.time.time_ns, now_ns + 1200 * kMillisecond);
      ASSERT_GE(result.time.time_ns, now_ns - 2200 * kMillisecond);
      last_ns = result.time.time_ns;
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::ingest
