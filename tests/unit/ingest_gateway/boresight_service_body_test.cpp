// The bodies of the Boresight service: values, flags, and contradictions.
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "interfaces/wire/boresight_service.hpp"
#include "services/ingest_gateway/codecs/boresight_service.hpp"
#include "tests/unit/ingest_gateway/memory_output.hpp"
#include "tests/unit/replay/document.hpp"

namespace boresight::ingest {
namespace {

using Bytes = std::vector<std::uint8_t>;

class ServiceBody : public testing::Test {
 protected:
  /// The body of the document's example.
  static Bytes example(const std::string& name) {
    const Bytes message = replay::document_example(name);
    return {message.begin() + 36, message.end()};
  }
  static void put_f32(Bytes& body, std::size_t at, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (std::size_t i = 0; i < 4; ++i) body[at + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
  }
  void take(const Bytes& body) {
    recording::Frame frame;
    frame.payload = body;
    list_.take(frame, {}, out_);
  }
  static constexpr std::size_t kFirst = 36, kSecond = 36 + 48;
  service::DetectionList list_;
  MemoryOutput out_;
};

TEST_F(ServiceBody, TheDocumentsExampleIsDecoded) {
  take(example("detection list"));
  ASSERT_EQ(out_.scans, 1u) << out_.last_fault;
  const RadarScan& scan = *out_.scan;
  ASSERT_EQ(scan.number_of_valid_detections, 2u);
  EXPECT_EQ(scan.cycle_counter, 1234u);
  EXPECT_EQ(out_.last_counter_bits, 32u);
  EXPECT_EQ(out_.last_sensor->time_ns, 1'767'225'600'250'000'000);
  EXPECT_TRUE(out_.last_sensor->synchronised);
  EXPECT_EQ(scan.fields, 0x3Fu);
  EXPECT_EQ(scan.range_rate_min_mps, -60.0F);
  EXPECT_EQ(scan.range_rate_max_mps, 20.0F);
  EXPECT_EQ(scan.range_m[0], 25.5F);
  EXPECT_EQ(scan.azimuth_rad[0], 0.25F);
  EXPECT_EQ(scan.elevation_rad[0], 0.0625F);
  EXPECT_EQ(scan.range_rate_mps[0], -13.25F);
  EXPECT_EQ(scan.range_std_m[0], 0.25F);
  EXPECT_EQ(scan.azimuth_std_rad[0], 0.0078125F);
  EXPECT_EQ(scan.elevation_std_rad[0], 0.015625F);
  EXPECT_EQ(scan.range_rate_std_mps[0], 0.0625F);
  EXPECT_EQ(scan.rcs_dbsm[0], 12.5F);
  EXPECT_EQ(scan.snr_db[0], 24.0F);
  EXPECT_EQ(scan.existence_probability[0], 0.75F);
  EXPECT_EQ(scan.detection_flags[0], 0u);
  EXPECT_EQ(scan.range_m[1], 120.0F);
  EXPECT_EQ(scan.range_rate_mps[1], -61.5F);
  EXPECT_EQ(scan.detection_flags[1], detection_flag::kAmbiguous);
  EgoReading ego;
  SensorStamp time;
  std::string_view problem;
  ASSERT_EQ(service::decode_ego(example("ego motion"), ego, time, problem), DecodeResult::kComplete) << problem;
  EXPECT_EQ(ego.speed_mps, 13.5);
  EXPECT_TRUE(ego.speed_is_signed);
  EXPECT_EQ(ego.yaw_rate_radps, 0.125);
  EXPECT_EQ(ego.steering_angle_rad, -0.5);
  EXPECT_EQ(time.time_ns, 1'767'225'600'260'000'000);
}

TEST_F(ServiceBody, AValueThatIsNotAllowedInvalidatesItsDetectionOnly) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  struct Case {
    std::size_t at;
    float value;
  };
  for (const Case c : {Case{0, nan},
                       {0, -0.5F},
                       {0, 1501.0F},
                       {4, 3.2F},
                       {4, nan},
                       {8, 1.6F},
                       {8, infinity},
                       {12, 151.0F},
                       {12, nan},
                       {32, 101.0F},
                       {36, -51.0F},
                       {40, 1.5F},
                       {40, nan}}) {
    Bytes body = example("detection list");
    put_f32(body, kFirst + c.at, c.value);
    take(body);
    ASSERT_EQ(out_.scan->number_of_valid_detections, 2u);
    EXPECT_EQ(out_.scan->detection_flags[0], detection_flag::kUnusable | (c.at == 12 ? detection_flag::kAmbiguous : 0))
        << c.at;
    EXPECT_EQ(out_.scan->detection_flags[1], detection_flag::kAmbiguous);
  }
  for (const std::size_t std_at : {16u, 20u, 24u, 28u}) {
    for (const float value : {nan, -1.0F, 101.0F}) {
      Bytes body = example("detection list");
      put_f32(body, kFirst + std_at, value);
      take(body);
      EXPECT_EQ(out_.scan->detection_flags[0], 0u) << "an invalid standard deviation is treated as not stated";
    }
  }
  EXPECT_EQ(out_.all_faults(), 0u);
}

TEST_F(ServiceBody, AFlagForbidsTheUseOrCastsDoubt) {
  namespace list = wire::boresight_service::detection_list;
  struct Case {
    std::uint16_t on_wire, expected;
  };
  for (const Case c :
       {Case{list::flag::kInvalid, detection_flag::kUnusable},
        {list::flag::kDoubted, detection_flag::kInvalid},
        {list::flag::kDoubted | list::flag::kAmbiguous, detection_flag::kInvalid | detection_flag::kAmbiguous}}) {
    Bytes body = example("detection list");
    body[kFirst + list::record::kFlags + 1] = static_cast<std::uint8_t>(c.on_wire);
    take(body);
    EXPECT_EQ(out_.scan->detection_flags[0], c.expected) << c.on_wire;
  }
}

TEST_F(ServiceBody, QuantitiesThatAreNotStatedAreIgnored) {
  Bytes body = example("detection list");
  body[23] = 0;  // fields
  put_f32(body, kFirst + 8, std::numeric_limits<float>::quiet_NaN());
  put_f32(body, kFirst + 40, 77.0F);
  take(body);
  EXPECT_EQ(out_.scan->fields, 0u);
  EXPECT_EQ(out_.scan->detection_flags[0], 0u);
  EXPECT_EQ(out_.scan->elevation_rad[0], 0.0F);
  EXPECT_EQ(out_.scan->existence_probability[0], 1.0F);
  EXPECT_EQ(out_.scan->range_std_m[0], 0.0F);
  EXPECT_EQ(out_.scan->range_rate_max_mps, 0.0F);
}

TEST_F(ServiceBody, ALaterMinorVersionMayAppendToHeaderAndRecords) {
  const Bytes old = example("detection list");
  Bytes body(old.begin(), old.begin() + 36);
  body[3] = 44;   // header bytes
  body[35] = 56;  // record bytes
  body.insert(body.end(), 8, 0xEE);
  for (const std::size_t record : {kFirst, kSecond}) {
    body.insert(body.end(), old.begin() + static_cast<std::ptrdiff_t>(record),
                old.begin() + static_cast<std::ptrdiff_t>(record) + 48);
    body.insert(body.end(), 8, 0xDD);
  }
  take(body);
  ASSERT_EQ(out_.scans, 1u) << out_.last_fault;
  EXPECT_EQ(out_.scan->range_m[0], 25.5F);
  EXPECT_EQ(out_.scan->range_m[1], 120.0F);
}

TEST_F(ServiceBody, ABodyThatContradictsItselfIsRejectedWithAReason) {
  const auto rejected = [&](std::size_t at, std::uint8_t value, const char* why) {
    Bytes body = example("detection list");
    body[at] = value;
    const std::size_t scans = out_.scans, faults = out_.all_faults();
    take(body);
    EXPECT_EQ(out_.scans, scans) << why;
    EXPECT_EQ(out_.all_faults(), faults + 1);
    EXPECT_THAT(out_.last_fault, testing::HasSubstr(why));
  };
  rejected(1, 2, "layout version");
  rejected(3, 32, "header bytes");
  rejected(3, 38, "header bytes");
  rejected(35, 44, "record bytes");
  rejected(35, 50, "record bytes");
  rejected(33, 3, "length");
  rejected(32, 4, "1024");
  rejected(8, 0x7F, "nanoseconds");
  Bytes body = example("detection list");
  body.push_back(0);
  take(body);
  EXPECT_THAT(out_.last_fault, testing::HasSubstr("length"));
  take(Bytes(20));
  EXPECT_THAT(out_.last_fault, testing::HasSubstr("36"));
}

}  // namespace
}  // namespace boresight::ingest
