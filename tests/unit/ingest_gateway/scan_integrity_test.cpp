#include "services/ingest_gateway/core/scan_integrity.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/drive.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

using namespace scan_integrity;

constexpr std::int64_t kScanCycle_ns = 50 * kMillisecond;
constexpr float kFloatNan = std::numeric_limits<float>::quiet_NaN();

/// A forward-looking radar, for tests that do not depend on the direction.
RadarConfig forward_radar() {
  RadarConfig radar;
  radar.id = 1;
  radar.mounting_pose.position_m = {3.6, 0.0, 0.5};
  radar.noise.range_rate_std_mps = 0.05;
  return radar;
}

EgoMotion motion(double speed_mps, double yaw_rate_radps = 0.0, bool direction_known = true) {
  EgoMotion ego{};
  ego.fields = ego_field::kSpeed | ego_field::kYawRate | (direction_known ? ego_field::kReverse : 0u);
  ego.speed_mps = static_cast<float>(speed_mps);
  ego.yaw_rate_radps = static_cast<float>(yaw_rate_radps);
  return ego;
}

// ---------------------------------------------------------------- scenes of stationary and moving objects

/// A scan of a forward-looking radar: the share `stationary` is stationary, the others move along the road.
void fill(RadarScan& scan, std::size_t detections, double stationary, double speed_mps, std::mt19937_64& random) {
  std::uniform_real_distribution<double> azimuth(-1.2, 1.2), range(3.0, 150.0), unit(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.05);
  scan.fields = 0;
  scan.integrity = 0;
  scan.number_of_valid_detections = static_cast<std::uint32_t>(detections);
  for (std::size_t i = 0; i < detections; ++i) {
    const double angle = azimuth(random);
    const bool oncoming = unit(random) < 0.5;
    const double own = unit(random) < stationary ? 0.0
                       : oncoming                ? -(0.7 + 0.5 * unit(random)) * speed_mps
                                                 : (0.6 + 0.6 * unit(random)) * speed_mps;
    scan.azimuth_rad[i] = static_cast<float>(angle);
    scan.range_m[i] = static_cast<float>(range(random));
    scan.range_rate_mps[i] = static_cast<float>((own - speed_mps) * std::cos(angle) + noise(random));
    scan.detection_flags[i] = 0;
  }
}

class Judged : public testing::Test {
 protected:
  std::uint16_t judge(const EgoMotion* ego = nullptr, unsigned bits = 8) {
    time_ns_ += kScanCycle_ns;
    ++scan_->cycle_counter;
    return judge_.judge(*scan_, time_ns_, time_ns_ + 10 * kMillisecond, bits, ego);
  }
  std::uint64_t contradictions(std::size_t scans, std::size_t detections, double stationary, const EgoMotion& ego,
                               double true_speed_mps) {
    const std::uint64_t before = judge_.counters().by_bit[5];
    for (std::size_t i = 0; i < scans; ++i) {
      fill(*scan_, detections, stationary, true_speed_mps, random_);
      EXPECT_EQ(judge(&ego) & ~kContradictsEgo, 0);
    }
    return judge_.counters().by_bit[5] - before;
  }
  /// Different in every call.
  void fill_anew(std::size_t detections = 20) { fill(*scan_, detections, 0.5, 10.0, random_); }

  std::mt19937_64 random_{21};
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  ScanJudge judge_{forward_radar()};
  std::int64_t time_ns_ = 1'000'000 * kMillisecond;
};

TEST_F(Judged, TrafficIsNoContradiction) {
  const EgoMotion ego = motion(20.0);
  EXPECT_EQ(contradictions(1200, 200, 0.2, ego, 20.0), 0u) << "a fifth is stationary";
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(contradictions(10, 200, 0.0, ego, 20.0), 0u) << "half a second of moving objects only";
    EXPECT_EQ(contradictions(20, 200, 0.5, ego, 20.0), 0u);
  }
}

TEST_F(Judged, ATrackerOfMovingObjectsOnlyIsNotSuspect) {
  EXPECT_EQ(contradictions(20 * 120, 10, 0.0, motion(25.0), 25.0), 0u);
}

TEST(ScanJudge, TracksOfTrafficAreNoMirroredAzimuth) {
  // A radar at a corner that reports tracks of moving objects only: a convoy ahead, and slower vehicles beside. Their
  // range rates are those of stationary reflectors at the azimuths with the opposite sign, near some directions.
  RadarConfig corner = forward_radar();
  corner.mounting_pose.yaw_rad = M_PI / 4.0;
  ScanJudge judge(corner);
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.05);
  const auto scan = std::make_unique<RadarScan>();
  const EgoMotion ego = motion(20.0);
  for (int i = 0; i < 20 * 120; ++i) {
    scan->number_of_valid_detections = 12;
    for (std::size_t k = 0; k < 12; ++k) {
      const bool is_convoy = k < 8;
      const double from_road_rad = is_convoy ? 0.01 * static_cast<double>(k) : 0.3 + 0.15 * static_cast<double>(k - 8);
      const double own_mps = is_convoy ? 19.0 : 12.0;
      scan->azimuth_rad[k] = static_cast<float>(from_road_rad - M_PI / 4.0 + 0.01 * noise(random));
      scan->range_m[k] = static_cast<float>(20.0 + 5.0 * static_cast<double>(k) + noise(random));
      scan->range_rate_mps[k] = static_cast<float>((own_mps - 20.0) * std::cos(from_road_rad) + noise(random));
      scan->detection_flags[k] = 0;
    }
    EXPECT_EQ(judge.judge(*scan, i * kScanCycle_ns, i * kScanCycle_ns, 0, &ego), 0) << i;
  }
}

TEST_F(Judged, AWrongSpeedIsReportedUntilItEnds) {
  EXPECT_EQ(contradictions(100, 100, 0.6, motion(15.0), 15.0), 0u);
  EXPECT_GT(contradictions(100, 100, 0.6, motion(22.5), 15.0), 40u);
  EXPECT_LT(contradictions(100, 100, 0.6, motion(15.0), 15.0), 60u);
  EXPECT_EQ(contradictions(100, 100, 0.6, motion(15.0), 15.0), 0u);
}

TEST_F(Judged, ATrackerWithTheWrongSignIsReportedWithinAMinute) {
  EXPECT_GT(contradictions(20 * 60, 10, 0.2, motion(-20.0), 20.0), 300u);
}

TEST_F(Judged, ReversingIsNoContradictionIfTheDirectionIsNotSignalled) {
  EXPECT_EQ(contradictions(400, 100, 0.8, motion(7.0, 0.0, false), -7.0), 0u);
  EXPECT_EQ(contradictions(400, 100, 0.8, motion(-7.0, 0.0, true), -7.0), 0u);
  EXPECT_GT(contradictions(400, 100, 0.8, motion(7.0, 0.0, true), -7.0), 300u);
}

TEST_F(Judged, BrakingHardIsNoContradictionThoughTheEgoMotionIsNewerThanTheScan) {
  for (int i = 0; i < 60; ++i) {
    const double speed_mps = 35.0 - 10.0 * 0.05 * i;
    fill(*scan_, 150, 0.6, speed_mps + 2.5, random_);  // measured 250 ms before the ego motion
    EgoMotion ego = motion(speed_mps);
    ego.longitudinal_acceleration_mps2 = -10.0F;
    ego.header.measurement_time_ns = time_ns_ + kScanCycle_ns + 250 * kMillisecond;
    EXPECT_EQ(judge(&ego), 0) << i;
  }
}

TEST_F(Judged, WithoutSpeedYawRateOrMotionTheEgoTestIsSkipped) {
  EgoMotion no_yaw_rate = motion(20.0), no_speed = motion(20.0), wild = motion(20.0);
  no_yaw_rate.fields = ego_field::kSpeed;
  no_speed.fields = ego_field::kYawRate;
  wild.speed_mps = kFloatNan;
  const EgoMotion slow = motion(4.9), standing = motion(0.0);
  for (const EgoMotion& ego : {no_yaw_rate, no_speed, slow, standing, wild}) {
    for (int i = 0; i < 200; ++i) {
      fill(*scan_, 100, 0.9, -10.0, random_);
      EXPECT_EQ(judge(&ego), 0);
    }
  }
  for (int i = 0; i < 200; ++i) {
    fill(*scan_, 100, 0.9, -10.0, random_);
    EXPECT_EQ(judge(nullptr), 0);
  }
}

// ---------------------------------------------------------------- counters and time

TEST_F(Judged, CountersOfAnyWidthWrapWithoutAFault) {
  for (const unsigned bits : {1u, 2u, 4u, 8u, 16u, 32u}) {
    ScanJudge judge(forward_radar());
    const std::uint32_t mask = bits == 32 ? ~0u : (1u << bits) - 1;
    std::uint32_t counter = mask - 10;
    for (int i = 0; i < 600; ++i) {
      fill_anew();
      scan_->cycle_counter = counter & mask;
      EXPECT_EQ(judge.judge(*scan_, i * kScanCycle_ns, i * kScanCycle_ns, bits, nullptr), 0) << bits << ' ' << i;
      ++counter;
    }
    EXPECT_EQ(judge.counters().lost_scans, 0u);
  }
}

TEST_F(Judged, GapsAreReportedAndCountedAcrossTheWrapAndBeyondItByTime) {
  struct Case {
    unsigned bits;
    std::uint32_t lost;
  };
  for (const Case c : {Case{4, 1}, Case{4, 14}, Case{4, 15}, Case{4, 16}, Case{4, 40}, Case{8, 1}, Case{8, 200},
                       Case{8, 255}, Case{8, 300}, Case{8, 1000}, Case{32, 1}, Case{32, 5000}}) {
    ScanJudge judge(forward_radar());
    std::uint32_t counter = 250;
    const std::uint32_t mask = c.bits == 32 ? ~0u : (1u << c.bits) - 1;
    for (int i = 0; i < 5; ++i) {
      fill_anew();
      if (i == 3) counter += c.lost;
      scan_->cycle_counter = counter & mask;
      // Cycles of a real sensor differ slightly from the configured time.
      const std::int64_t time_ns = counter * (kScanCycle_ns + 200'000);
      const std::uint16_t expected = i == 3 ? kCounterGap : 0;
      EXPECT_EQ(judge.judge(*scan_, time_ns, time_ns, c.bits, nullptr), expected) << c.bits << ' ' << c.lost;
      ++counter;
    }
    EXPECT_EQ(judge.counters().lost_scans, c.lost) << c.bits;
  }
}

TEST_F(Judged, ARepeatedCounterIsReported) {
  for (int i = 0; i < 20; ++i) {
    fill_anew();
    if (i == 7) --scan_->cycle_counter;
    EXPECT_EQ(judge(), i == 7 ? kRepeated : 0) << i;
  }
  EXPECT_EQ(judge_.counters().by_bit[1], 1u);
  EXPECT_EQ(judge_.counters().lost_scans, 0u);
}

TEST_F(Judged, ARestartedCounterIsNoLossOfTwoBillionScans) {
  for (int i = 0; i < 20; ++i) {
    fill_anew();
    if (i == 0) scan_->cycle_counter = 100'000;
    if (i == 10) {
      scan_->cycle_counter = 0;
      time_ns_ += 60 * kScanCycle_ns;
    }
    EXPECT_EQ(judge(nullptr, 32), i == 10 ? kCounterGap : 0) << i;
  }
  EXPECT_EQ(judge_.counters().lost_scans, 60u);
}

TEST_F(Judged, AConstantCounterIsIgnored) {
  for (int i = 0; i < 100; ++i) {
    fill_anew();
    scan_->cycle_counter = ~0u;  // judge() adds one
    EXPECT_EQ(judge(), i > 0 && i <= 10 ? kRepeated : 0) << i;
  }
  time_ns_ += kScanCycle_ns;
  scan_->cycle_counter = ~0u;
  fill_anew();
  EXPECT_EQ(judge(), kCounterGap) << "detected by time";
}

TEST_F(Judged, WithoutACounterGapsAreFoundByTime) {
  for (int i = 0; i < 20; ++i) {
    fill_anew();
    if (i == 5) time_ns_ += kScanCycle_ns * 4 / 10;  // late, not lost
    if (i == 9) time_ns_ += kScanCycle_ns;
    if (i == 15) time_ns_ += 7 * kScanCycle_ns;
    EXPECT_EQ(judge(nullptr, 0), i == 9 || i == 15 ? kCounterGap : 0) << i;
  }
  EXPECT_EQ(judge_.counters().lost_scans, 8u);
}

TEST_F(Judged, WithoutACounterTheSameContentAndStampAreARepetition) {
  for (int i = 0; i < 20; ++i) {
    if (i != 9) fill_anew();
    if (i == 9 || i == 10) time_ns_ -= kScanCycle_ns;
    const int verdict = judge(nullptr, 0) & ~kStale;
    EXPECT_EQ(verdict, i == 9 ? kRepeated : 0) << i << ": other content with the same stamp is no repetition";
  }
}

TEST_F(Judged, OldDataAndStampsThatDoNotAdvanceAreStale) {
  const auto at = [&](std::int64_t measured_ms, std::int64_t received_ms) {
    fill_anew();
    ++scan_->cycle_counter;
    return judge_.judge(*scan_, measured_ms * kMillisecond, received_ms * kMillisecond, 8, nullptr);
  };
  EXPECT_EQ(at(1000, 1247), 0) << "as a recorded ARS548";
  EXPECT_EQ(at(1050, 1550), 0);
  EXPECT_EQ(at(1100, 1601), kStale);
  EXPECT_EQ(at(1300, 1650), 0);
  EXPECT_EQ(at(1300, 1651), 0) << "two in one burst are not judged";
  EXPECT_EQ(at(1300, 1665), kStale) << "stands still";
  EXPECT_EQ(at(1299, 1700), kStale) << "goes back";
  EXPECT_EQ(at(1400, 1750), 0);
  EXPECT_EQ(at(200, 300), 0) << "all clocks went back together: another recording";
}

// ---------------------------------------------------------------- content

TEST_F(Judged, AFrozenRadarIsReported) {
  const EgoMotion moving = motion(4.0), standing = motion(0.0);
  fill_anew(30);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(judge(&moving), i >= 3 ? kFrozen : 0) << i;
  fill_anew(30);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(judge(&standing), i >= 10 ? kFrozen : 0) << i;
  fill_anew(30);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(judge(nullptr), i >= 10 ? kFrozen : 0) << i;
  scan_->range_m[17] = std::nextafter(scan_->range_m[17], 0.0F);
  EXPECT_EQ(judge(&moving), 0) << "one bit is a difference";
  // One or two tracks of a coarse tracker may be equal for some time, and empty scans are equal.
  for (const std::size_t few : {0u, 1u, 3u}) {
    fill_anew(few);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(judge(&moving), 0);
  }
}

TEST_F(Judged, ManyImplausibleDetectionsAreReported) {
  const auto with = [&](std::size_t bad, const std::function<void(std::size_t)>& spoil) {
    fill_anew(50);
    for (std::size_t i = 0; i < bad; ++i) spoil(i * 4);
    return judge();
  };
  const std::vector<std::function<void(std::size_t)>> spoils = {
      [&](std::size_t i) { scan_->range_m[i] = kFloatNan; },
      [&](std::size_t i) { scan_->range_m[i] = -1.0F; },
      [&](std::size_t i) { scan_->range_m[i] = 361.0F; },
      [&](std::size_t i) { scan_->azimuth_rad[i] = kFloatNan; },
      [&](std::size_t i) { scan_->azimuth_rad[i] = 1.3F + 0.18F; },
      [&](std::size_t i) { scan_->azimuth_rad[i] = -7.0F; },
      [&](std::size_t i) { scan_->range_rate_mps[i] = std::numeric_limits<float>::infinity(); },
      [&](std::size_t i) { scan_->range_rate_mps[i] = -151.0F; },
      [&](std::size_t i) {
        scan_->fields |= scan_field::kElevation;
        std::fill_n(scan_->elevation_rad.data(), 50, 0.0F);
        for (std::size_t k = 0; k <= i; k += 4) scan_->elevation_rad[k] = 0.6F;
      },
      [&](std::size_t i) {
        scan_->azimuth_rad[i] = kFloatNan;
        scan_->detection_flags[i] = detection_flag::kInvalid;  // does not excuse NaN
      },
  };
  for (std::size_t k = 0; k < spoils.size(); ++k) {
    EXPECT_EQ(with(10, spoils[k]), kImplausible) << k;
    EXPECT_EQ(with(9, spoils[k]), 0) << k << ": less than a fifth";
  }
  EXPECT_EQ(with(12,
                 [&](std::size_t i) {
                   scan_->azimuth_rad[i] = 2.0F;
                   scan_->detection_flags[i] = detection_flag::kInvalid;
                 }),
            0)
      << "the sensor marks the angle as invalid";
  fill_anew(4);
  scan_->range_m[0] = scan_->range_m[1] = 1000.0F;
  EXPECT_EQ(judge(), 0) << "two of four are not many";
}

TEST_F(Judged, ManyCopiesOfDetectionsAreReported) {
  const auto copy = [&](std::size_t detections, std::size_t copies) {
    fill_anew(detections);
    for (std::size_t i = 0; i < copies; ++i) {
      const std::size_t to = detections - 1 - i;
      scan_->range_m[to] = scan_->range_m[i % 3];
      scan_->azimuth_rad[to] = scan_->azimuth_rad[i % 3];
      scan_->range_rate_mps[to] = scan_->range_rate_mps[i % 3];
    }
    return judge();
  };
  EXPECT_EQ(copy(100, 25), kImpossibleCopies);
  EXPECT_EQ(copy(100, 24), 0);
  EXPECT_EQ(copy(12, 8), kImpossibleCopies);
  EXPECT_EQ(copy(11, 7), 0);
  EXPECT_EQ(copy(1024, 1000), kImpossibleCopies);
  EXPECT_EQ(copy(1024, 0), 0);
}

TEST_F(Judged, BitsOfTheDecoderAreKeptAndCounted) {
  fill_anew();
  scan_->integrity = kIncomplete;
  EXPECT_EQ(judge(), kIncomplete);
  EXPECT_EQ(judge_.counters().by_bit[6], 1u);
  EXPECT_EQ(judge_.counters().scans, 1u);
}

TEST_F(Judged, RandomScansAreJudgedWithoutAllocatingAndInBoundedTime) {
  const EgoMotion ego = motion(20.0, 0.1);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int i = 0; i < 3000; ++i) {
      auto* const words = reinterpret_cast<std::uint64_t*>(scan_.get());
      for (int k = 0; k < 1000; ++k) words[random_() % (sizeof(RadarScan) / 8)] = random_();
      scan_->integrity = 0;
      if (i % 3 == 0) scan_->number_of_valid_detections = static_cast<std::uint32_t>(random_() % 1100);
      const auto time_ns = static_cast<std::int64_t>(random_());
      static_cast<void>(judge_.judge(*scan_, i % 2 == 0 ? time_ns : i * kScanCycle_ns,
                                     static_cast<std::int64_t>(random_()), static_cast<unsigned>(random_() % 40),
                                     &ego));
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(judge_.counters().scans, 3000u);
}

}  // namespace
}  // namespace boresight::ingest
