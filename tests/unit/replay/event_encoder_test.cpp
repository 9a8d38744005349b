#include "services/replay/core/event_encoder.hpp"

#include <bit>
#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/e2e/checker.hpp"
#include "services/replay/core/datagrams.hpp"
#include "services/replay/core/synthetic.hpp"
#include "tests/unit/replay/document.hpp"

namespace boresight::replay {
namespace {

namespace service = wire::boresight_service;
namespace list = service::detection_list;
using ::testing::ElementsAreArray;
using Bytes = std::vector<std::uint8_t>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr DataIds kDataIds{service::data_id(3, service::kEventDetectionList),
                           service::data_id(3, service::kEventEgoMotion)};

std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
  return value;
}
std::uint16_t u16_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}
float f32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<float>(u32_at(bytes, at));
}

void set_detection(RadarScan& scan, std::size_t i, const std::array<float, 11>& v, std::uint16_t flags) {
  scan.range_m[i] = v[0];
  scan.azimuth_rad[i] = v[1];
  scan.elevation_rad[i] = v[2];
  scan.range_rate_mps[i] = v[3];
  scan.range_std_m[i] = v[4];
  scan.azimuth_std_rad[i] = v[5];
  scan.elevation_std_rad[i] = v[6];
  scan.range_rate_std_mps[i] = v[7];
  scan.rcs_dbsm[i] = v[8];
  scan.snr_db[i] = v[9];
  scan.existence_probability[i] = v[10];
  scan.detection_flags[i] = flags;
}

constexpr std::array<float, 11> kFirst{25.5F,     0.25F,   0.0625F, -13.25F, 0.25F, 0.0078125F,
                                       0.015625F, 0.0625F, 12.5F,   24.0F,   0.75F};
constexpr std::array<float, 11> kSecondDetection{120.0F,    -0.5F,   -0.03125F, -61.5F, 0.5F, 0.0078125F,
                                                 0.015625F, 0.0625F, -3.5F,     15.0F,  1.0F};
constexpr SensorTime kTime{1767225600'250'000'000, 1};

/// The scan of the document's first example.
std::unique_ptr<RadarScan> example_scan() {
  auto scan = std::make_unique<RadarScan>();
  scan->cycle_counter = 1234;
  scan->number_of_valid_detections = 2;
  scan->fields = 0x3F;
  scan->range_rate_min_mps = -60.0F;
  scan->range_rate_max_mps = 20.0F;
  set_detection(*scan, 0, kFirst, 0);
  set_detection(*scan, 1, kSecondDetection, detection_flag::kAmbiguous);
  return scan;
}

EgoMotion example_ego() {
  EgoMotion ego{};
  ego.fields = 0xF;
  ego.speed_mps = 13.5F;
  ego.yaw_rate_radps = 0.125F;
  ego.steering_angle_rad = -0.5F;
  return ego;
}

/// An encoder whose next list has session id 7 and E2E counter 5, as in the example.
EventEncoder example_encoder() {
  EventEncoder encoder(kDataIds);
  const auto empty = std::make_unique<RadarScan>();
  for (int i = 0; i < 5; ++i) static_cast<void>(encoder.detection_list(*empty, kTime));
  return encoder;
}

TEST(EventEncoder, WritesTheDocumentsExamples) {
  const auto scan = example_scan();
  // The session counter is common to both events, the E2E counters are not: five lists and one ego motion make the
  // next list's session 7 and its counter 5.
  EventEncoder encoder = example_encoder();
  static_cast<void>(encoder.ego_motion(example_ego(), kTime));
  const Bytes expected = document_example("detection list");
  ASSERT_EQ(expected.size(), 168u);
  EXPECT_THAT(encoder.detection_list(*scan, kTime), ElementsAreArray(expected));

  EventEncoder second = example_encoder();
  for (int i = 0; i < 2; ++i) static_cast<void>(second.detection_list(*scan, kTime));
  EXPECT_THAT(second.ego_motion(example_ego(), {1767225600'260'000'000, 1}),
              ElementsAreArray(document_example("ego motion")));
}

TEST(EventEncoder, WritesTheDocumentsSegments) {
  auto scan = example_scan();
  scan->number_of_valid_detections = 40;
  for (std::size_t i = 0; i < 40; ++i) set_detection(*scan, i, kFirst, 0);
  EventEncoder encoder = example_encoder();
  static_cast<void>(encoder.ego_motion(example_ego(), kTime));
  std::vector<Bytes> datagrams;
  for_each_datagram(encoder.detection_list(*scan, kTime),
                    [&](std::span<const std::uint8_t> d) { datagrams.emplace_back(d.begin(), d.end()); });
  ASSERT_EQ(datagrams.size(), 2u);
  EXPECT_EQ(datagrams[0].size(), 16u + 4u + 1392u);
  EXPECT_EQ(datagrams[1].size(), 16u + 4u + 1976u - 1392u);
  for (Bytes& d : datagrams) d.resize(72);
  EXPECT_THAT(datagrams[0], ElementsAreArray(document_example("first segment, first 72 bytes")));
  EXPECT_THAT(datagrams[1], ElementsAreArray(document_example("last segment, first 72 bytes")));
}

TEST(EventEncoder, AFullListPassesTheE2eCheckAndHasTheDocumentsLength) {
  auto scan = std::make_unique<RadarScan>();
  write_synthetic_scan(3, {}, 1, 1024, *scan);
  EventEncoder encoder(kDataIds);
  e2e::Config config;
  config.profile = e2e::Profile::kP07;
  config.data_id = 0x42530301;
  config.offset_bytes = 8;
  e2e::Checker checker(config);
  for (int i = 0; i < 3; ++i) {
    const auto message = encoder.detection_list(*scan, kTime);
    EXPECT_EQ(message.size(), 49224u);
    EXPECT_EQ(checker.check(message.subspan(8)), i == 0 ? e2e::Status::kInitial : e2e::Status::kOk);
  }
}

TEST(EventBody, ValuesThatAreNotAllowedAreFlaggedAndNotSent) {
  auto scan = example_scan();
  scan->number_of_valid_detections = 6;
  for (std::size_t i = 0; i < 6; ++i) set_detection(*scan, i, kFirst, 0);
  scan->range_m[0] = kNan;
  scan->azimuth_rad[1] = 3.2F;
  scan->range_rate_mps[2] = -std::numeric_limits<float>::infinity();
  scan->snr_db[3] = kNan;
  scan->range_std_m[4] = kNan;
  scan->azimuth_std_rad[4] = -1.0F;
  scan->detection_flags[5] = detection_flag::kInvalid | detection_flag::kAmbiguous;
  Bytes body(1000);
  ASSERT_EQ(write_detection_list(*scan, kTime, body), 36u + 6 * 48);
  const auto record = [&](std::size_t i) { return std::span(body).subspan(36 + i * 48, 48); };
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(u16_at(record(i), list::record::kFlags), list::flag::kInvalid) << i;
  EXPECT_EQ(u16_at(record(5), list::record::kFlags), list::flag::kDoubted | list::flag::kAmbiguous);
  EXPECT_EQ(u32_at(record(0), list::record::kRange_m), 0u);
  EXPECT_EQ(f32_at(record(0), list::record::kAzimuth_rad), 0.25F);
  EXPECT_EQ(u32_at(record(1), list::record::kAzimuth_rad), 0u);
  EXPECT_EQ(u32_at(record(2), list::record::kRangeRate_mps), 0u);
  EXPECT_EQ(u32_at(record(3), list::record::kSnr_db), 0u);
  EXPECT_EQ(u16_at(record(4), list::record::kFlags), 0u);
  EXPECT_EQ(u32_at(record(4), list::record::kRangeStd_m), 0u);
  EXPECT_EQ(u32_at(record(4), list::record::kAzimuthStd_rad), 0u);
  EXPECT_EQ(f32_at(record(4), list::record::kElevationStd_rad), 0.015625F);
}

TEST(EventBody, QuantitiesThatAreNotMeasuredAreSentAsSpecified) {
  auto scan = example_scan();
  scan->fields = 1u << 31;
  scan->elevation_rad[0] = kNan;  // no meaning without its bit
  Bytes body(200);
  ASSERT_EQ(write_detection_list(*scan, {-5, 2}, body), 132u);
  EXPECT_EQ(u32_at(body, list::kFields), 0u);
  EXPECT_EQ(u32_at(body, list::kSeconds), 0u);
  EXPECT_EQ(u32_at(body, list::kNanoseconds), 0u);
  EXPECT_EQ(body[list::kSyncStatus], 2);
  EXPECT_EQ(u32_at(body, list::kRangeRateMin_mps), 0u);
  const auto record = std::span(body).subspan(36, 48);
  EXPECT_EQ(f32_at(record, list::record::kRange_m), 25.5F);
  for (const std::size_t at : {list::record::kElevation_rad, list::record::kRangeStd_m, list::record::kAzimuthStd_rad,
                               list::record::kElevationStd_rad, list::record::kRangeRateStd_mps,
                               list::record::kRcs_dbsm, list::record::kSnr_db}) {
    EXPECT_EQ(u32_at(record, at), 0u) << at;
  }
  EXPECT_EQ(f32_at(record, list::record::kExistenceProbability), 1.0F);
  EXPECT_EQ(u16_at(record, list::record::kFlags), 0u);
}

TEST(EventBody, AnInvalidIntervalIsNotStated) {
  auto scan = example_scan();
  Bytes body(200);
  for (const auto& [min, max] : {std::pair{kNan, 20.0F}, {20.0F, 20.0F}, {-60.0F, 200.0F}}) {
    scan->range_rate_min_mps = min;
    scan->range_rate_max_mps = max;
    ASSERT_EQ(write_detection_list(*scan, kTime, body), 132u);
    EXPECT_EQ(u32_at(body, list::kFields), 0x1Fu);
    EXPECT_EQ(u32_at(body, list::kRangeRateMin_mps), 0u);
    EXPECT_EQ(u32_at(body, list::kRangeRateMax_mps), 0u);
  }
}

TEST(EventBody, EgoMotionKeepsToItsFields) {
  namespace ego_wire = service::ego_motion;
  Bytes body(32);
  EgoMotion ego = example_ego();
  ego.speed_mps = -13.5F;
  ASSERT_EQ(write_ego_motion(ego, kTime, body), 32u);
  EXPECT_EQ(f32_at(body, ego_wire::kSpeed_mps), -13.5F);
  ego.fields &= ~ego_field::kReverse;  // a sign without a known direction has no meaning
  ASSERT_EQ(write_ego_motion(ego, kTime, body), 32u);
  EXPECT_EQ(f32_at(body, ego_wire::kSpeed_mps), 13.5F);
  EXPECT_EQ(u32_at(body, ego_wire::kFields), 7u);
  ego = example_ego();
  ego.speed_mps = kNan;
  ego.yaw_rate_radps = 6.0F;
  ASSERT_EQ(write_ego_motion(ego, kTime, body), 32u);
  EXPECT_EQ(u32_at(body, ego_wire::kFields), ego_wire::field::kSteeringAngle);
  EXPECT_EQ(u32_at(body, ego_wire::kSpeed_mps), 0u);
  EXPECT_EQ(u32_at(body, ego_wire::kYawRate_radps), 0u);
}

TEST(EventBody, NothingIsWrittenBeyondTheEnd) {
  const auto scan = example_scan();
  Bytes body(132, 0xEE);
  EXPECT_EQ(write_detection_list(*scan, kTime, std::span(body).first(131)), 0u);
  EXPECT_EQ(body.back(), 0xEE);
  EXPECT_EQ(write_ego_motion(example_ego(), kTime, std::span(body).first(31)), 0u);
}

TEST(SessionCounter, IsNeverZeroAndReportsItsWrap) {
  someip::SessionCounter counter;
  for (std::uint32_t i = 1; i <= 0xFFFF; ++i) {
    ASSERT_EQ(counter.take(), i);
    ASSERT_FALSE(counter.wrapped());
  }
  EXPECT_EQ(counter.take(), 1);
  EXPECT_TRUE(counter.wrapped());
  EXPECT_EQ(counter.take(), 2);
  EXPECT_TRUE(counter.wrapped());
}

TEST(Synthetic, IsTheSameEachTimeAndFitsItsEgoMotion) {
  const auto a = std::make_unique<RadarScan>(), b = std::make_unique<RadarScan>(), c = std::make_unique<RadarScan>();
  MountingPose left;
  left.yaw_rad = 1.2;
  write_synthetic_scan(2, left, 7, 1024, *a);
  write_synthetic_scan(2, left, 7, 1024, *b);
  write_synthetic_scan(2, left, 8, 1024, *c);
  ASSERT_EQ(a->number_of_valid_detections, 1024u);
  EXPECT_EQ(a->range_m.values, b->range_m.values);
  EXPECT_EQ(a->range_rate_mps.values, b->range_rate_mps.values);
  EXPECT_NE(a->range_m.values, c->range_m.values);
  EgoMotion ego{};
  write_synthetic_ego(ego);
  double squares = 0.0;
  for (std::size_t i = 0; i < 1024; ++i) {
    const double expected =
        -ego.speed_mps * std::cos(a->elevation_rad[i]) * std::cos(static_cast<double>(a->azimuth_rad[i]) + 1.2);
    squares += std::pow(a->range_rate_mps[i] - expected, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / 1024), 0.05, 0.005);
}

}  // namespace
}  // namespace boresight::replay
