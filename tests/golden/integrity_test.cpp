// The integrity verdict on real recordings: no fault in the original data, and the right fault in damaged data.
#include <algorithm>
#include <functional>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "services/ingest_gateway/core/scan_integrity.hpp"
#include "tests/golden/support/decoded.hpp"

namespace boresight::golden {
namespace {

using namespace scan_integrity;
namespace fs = std::filesystem;

const fs::path kDrive = shared_data() / "comma2k19_seg40/radar_ego.candump.log";
const fs::path kSoundArs548 = shared_data() / "nebula_ars548_srr520/ars548_real_2msgs_ipfrag.pcap";
constexpr std::int64_t kLatency_ns = 75'000'000;

/// Changes a scan before it gets to the judge; false: the scan does not arrive.
using Damage = std::function<bool(RadarScan& scan, std::size_t index)>;

class RealDriveIntegrity : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (fs::exists(kDrive)) decoding_ = decode(vehicle("comma2k19"), kDrive);
  }
  static void TearDownTestSuite() { decoding_ = {}; }
  void SetUp() override { REQUIRE_RECORDING(kDrive); }

  static ingest::IntegrityCounters judge(const Damage& damage) {
    ingest::ScanJudge judge(vehicle("comma2k19").radars.front());
    const auto scan = std::make_unique<RadarScan>();
    const EgoMotion* ego = nullptr;
    std::size_t index = 0;
    for (const Decoded& message : decoding_.messages) {
      if (message.ego) ego = message.ego.get();
      if (!message.scan) continue;
      *scan = *message.scan;
      scan->integrity = 0;
      const std::int64_t received_ns = scan->header.measurement_time_ns + kLatency_ns;
      if (!damage(*scan, index++)) continue;
      static_cast<void>(judge.judge(*scan, scan->header.measurement_time_ns, received_ns, 8, ego));
    }
    return judge.counters();
  }
  static ingest::IntegrityCounters judge_rates(float factor) {
    return judge([factor](RadarScan& scan, std::size_t) {
      for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) scan.range_rate_mps[i] *= factor;
      return true;
    });
  }
  static inline Decoding decoding_;
};

TEST_F(RealDriveIntegrity, OriginalDataHasNoFault) {
  const auto counters = judge([](RadarScan&, std::size_t) { return true; });
  EXPECT_EQ(counters.scans, 1200u);
  for (const Decoded& message : decoding_.messages) {
    if (message.scan) {
      EXPECT_EQ(message.scan->integrity, 0) << "the gateway's own verdict";
    }
  }
  EXPECT_EQ(counters.lost_scans, 0u);
  for (const std::uint64_t accused : counters.by_bit) EXPECT_EQ(accused, 0u);
}

TEST_F(RealDriveIntegrity, DroppedScansAreCounted) {
  const auto counters = judge([](RadarScan&, std::size_t index) {
    const bool many = index >= 100 && index < 400;  // more than the period of the 8-bit counter
    return !many && index % 97 != 50;
  });
  EXPECT_EQ(counters.lost_scans, 300u + 9u);
  EXPECT_EQ(counters.by_bit[0], 10u);
  EXPECT_EQ(counters.by_bit[1], 0u);
}

TEST_F(RealDriveIntegrity, RepeatedScanIsReported) {
  RadarScan before{};
  const auto counters = judge([&before](RadarScan& scan, std::size_t index) {
    if (index == 500) {
      const std::int64_t time_ns = scan.header.measurement_time_ns;
      scan = before;
      scan.header.measurement_time_ns = time_ns;
    }
    before = scan;
    return true;
  });
  EXPECT_EQ(counters.by_bit[1], 1u);
  EXPECT_EQ(counters.by_bit[0], 1u) << "and the replaced scan is missing";
}

TEST_F(RealDriveIntegrity, FrozenRadarIsReported) {
  RadarScan frozen{};
  const auto counters = judge([&frozen](RadarScan& scan, std::size_t index) {
    if (index == 600) frozen = scan;
    if (index > 600) {
      const std::uint32_t counter = scan.cycle_counter;
      const std::int64_t time_ns = scan.header.measurement_time_ns;
      scan = frozen;
      scan.cycle_counter = counter;
      scan.header.measurement_time_ns = time_ns;
    }
    return true;
  });
  EXPECT_EQ(counters.by_bit[2], 597u) << "from the fourth equal scan on";
}

TEST_F(RealDriveIntegrity, StoppedClockIsReported) {
  std::int64_t stop_ns = 0;
  ingest::ScanJudge judge(vehicle("comma2k19").radars.front());
  std::size_t index = 0;
  for (const Decoded& message : decoding_.messages) {
    if (!message.scan) continue;
    const std::int64_t time_ns = message.scan->header.measurement_time_ns;
    if (++index == 300) stop_ns = time_ns;
    const std::int64_t measured_ns = stop_ns != 0 ? stop_ns : time_ns;
    static_cast<void>(judge.judge(*message.scan, measured_ns, time_ns + kLatency_ns, 8, nullptr));
  }
  EXPECT_EQ(judge.counters().by_bit[3], 900u);
}

TEST_F(RealDriveIntegrity, RangeRatesThatContradictTheSpeedAreReported) {
  // The radar sends a dozen tracks, mostly of traffic, so the detection takes up to half a minute.
  for (const float factor : {1.5F, 0.7F, -1.0F}) {
    const auto counters = judge_rates(factor);
    EXPECT_GT(counters.by_bit[5], 300u) << factor;
    for (const std::size_t other : {0u, 1u, 2u, 3u, 4u, 6u, 7u}) EXPECT_EQ(counters.by_bit[other], 0u) << factor;
  }
}

TEST(RealArs548Integrity, OriginalDataHasNoFault) {
  REQUIRE_RECORDING(kSoundArs548);
  const VehicleConfig car = vehicle("ars548_single");
  const Decoding decoding = decode(car, kSoundArs548);
  ingest::ScanJudge judge(car.radars.front());
  for (const Decoded& message : decoding.messages) {
    if (!message.scan) continue;
    const std::int64_t time_ns = message.scan->header.measurement_time_ns;
    EXPECT_EQ(message.scan->number_of_valid_detections, 308u);
    EXPECT_EQ(message.scan->integrity, 0) << "the gateway's own verdict";
    EXPECT_EQ(judge.judge(*message.scan, time_ns, time_ns + 247'000'000, 0, nullptr), 0);
  }
  EXPECT_EQ(judge.counters().scans, 1u);
}

TEST(RealArs548Integrity, RangeRatesFitTheSpeedAndScaledOnesDoNot) {
  REQUIRE_RECORDING(kSoundArs548);
  const VehicleConfig car = vehicle("ars548_single");
  const Decoding decoding = decode(car, kSoundArs548);
  const auto scan = std::make_unique<RadarScan>();
  for (const Decoded& message : decoding.messages) {
    if (message.scan) *scan = *message.scan;
  }
  EgoMotion ego{};
  ego.fields = ego_field::kSpeed | ego_field::kYawRate | ego_field::kReverse;
  ego.speed_mps = 6.19F;  // speed of the scan's own stationary detections, see Ars548.StationaryDetections…
  // The one recorded scan is repeated, each time with its detections in another order.
  std::mt19937_64 random(1);
  const auto contradictions = [&](float factor) {
    ingest::ScanJudge judge(car.radars.front());
    for (std::size_t i = 0; i < scan->number_of_valid_detections; ++i) scan->range_rate_mps[i] *= factor;
    for (int k = 0; k < 100; ++k) {
      const std::size_t n = scan->number_of_valid_detections;
      for (std::size_t i = n - 1; i > 0; --i) {
        const std::size_t j = random() % (i + 1);
        std::swap(scan->range_m[i], scan->range_m[j]);
        std::swap(scan->azimuth_rad[i], scan->azimuth_rad[j]);
        std::swap(scan->elevation_rad[i], scan->elevation_rad[j]);
        std::swap(scan->range_rate_mps[i], scan->range_rate_mps[j]);
        std::swap(scan->detection_flags[i], scan->detection_flags[j]);
      }
      const std::int64_t time_ns = k * std::int64_t{50'000'000};
      EXPECT_EQ(judge.judge(*scan, time_ns, time_ns, 0, &ego) & ~kContradictsEgo, 0);
    }
    for (std::size_t i = 0; i < scan->number_of_valid_detections; ++i) scan->range_rate_mps[i] /= factor;
    return judge.counters().by_bit[5];
  };
  EXPECT_EQ(contradictions(1.0F), 0u);
  EXPECT_GT(contradictions(1.5F), 70u);
  EXPECT_GT(contradictions(0.7F), 70u);
  EXPECT_GT(contradictions(-1.0F), 70u);
}

}  // namespace
}  // namespace boresight::golden
