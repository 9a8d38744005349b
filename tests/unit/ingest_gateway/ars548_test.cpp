#include "interfaces/wire/ars548.hpp"

#include <bit>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "services/common/e2e/protector.hpp"
#include "services/ingest_gateway/codecs/ars548.hpp"
#include "services/simulator/wire/ars548_encoder.hpp"
#include "tests/unit/ingest_gateway/memory_output.hpp"

namespace boresight::ingest::ars548 {
namespace {

namespace layout = wire::ars548;
using simulator::wire::Ars548List;

void put_f32(Ars548List& bytes, std::size_t at, float value) {
  const auto raw = std::bit_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(raw >> (24 - 8 * i));
}
void put_u32(Ars548List& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

class Ars548Test : public testing::Test {
 protected:
  Ars548Test() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    sent_->number_of_valid_detections = 300;
    for (std::size_t i = 0; i < 300; ++i) {
      sent_->range_m[i] = 50.0F + 49.0F * unit(random);
      sent_->azimuth_rad[i] = 1.2F * unit(random);
      sent_->elevation_rad[i] = 0.3F * unit(random);
      sent_->range_rate_mps[i] = 20.0F * unit(random);
      sent_->rcs_dbsm[i] = std::round(20.0F * unit(random));
      sent_->range_std_m[i] = 0.2F;
      sent_->azimuth_std_rad[i] = 0.008F;
      sent_->elevation_std_rad[i] = 0.01F;
      sent_->range_rate_std_mps[i] = 0.25F;
      sent_->existence_probability[i] = 0.9F;
    }
    simulator::wire::encode_ars548(*sent_, 1'700'000'000'123'456'789, *bytes_);
  }
  DecodeResult check_bytes() { return check(*bytes_, problem_); }
  std::size_t record(std::size_t i) const { return layout::kDetections + i * layout::kDetectionBytes; }

  std::unique_ptr<RadarScan> sent_ = std::make_unique<RadarScan>(), scan_ = std::make_unique<RadarScan>();
  std::unique_ptr<Ars548List> bytes_ = std::make_unique<Ars548List>();
  std::string_view problem_;
};

TEST_F(Ars548Test, DecodesWhatTheIndependentEncoderWrote) {
  ASSERT_EQ(check_bytes(), DecodeResult::kComplete);
  const SensorStamp time = decode(*bytes_, *scan_);
  EXPECT_EQ(time.time_ns, 1'700'000'000'123'456'789);
  EXPECT_TRUE(time.synchronised);
  ASSERT_EQ(scan_->number_of_valid_detections, 300u);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ(scan_->range_m[i], sent_->range_m[i]);
    EXPECT_EQ(scan_->azimuth_rad[i], sent_->azimuth_rad[i]);
    EXPECT_EQ(scan_->elevation_rad[i], sent_->elevation_rad[i]);
    EXPECT_EQ(scan_->range_rate_mps[i], sent_->range_rate_mps[i]);
    EXPECT_EQ(scan_->rcs_dbsm[i], sent_->rcs_dbsm[i]);
    EXPECT_EQ(scan_->azimuth_std_rad[i], 0.008F);
    EXPECT_NEAR(scan_->existence_probability[i], 0.9F, 1e-6);
    EXPECT_EQ(scan_->detection_flags[i] & detection_flag::kInvalid, 0) << i;
  }
}

TEST_F(Ars548Test, WrongLengthsAndHeadersAreRefusedWithAReason) {
  EXPECT_EQ(check(std::span(*bytes_).first(5), problem_), DecodeResult::kBadLength);
  EXPECT_EQ(check(std::span(*bytes_).first(35335), problem_), DecodeResult::kBadLength);
  EXPECT_NE(problem_.find("35336"), std::string_view::npos);
  Ars548List original = *bytes_;
  (*bytes_)[7] = static_cast<std::uint8_t>((*bytes_)[7] + 1);
  EXPECT_EQ(check_bytes(), DecodeResult::kBadLength);
  *bytes_ = original;
  (*bytes_)[3] = 0x77;
  EXPECT_EQ(check_bytes(), DecodeResult::kUnknownMessage);
  *bytes_ = original;
  put_u32(*bytes_, layout::kNumberOfDetections, 801);
  EXPECT_EQ(check_bytes(), DecodeResult::kBadValue);
  EXPECT_NE(problem_.find("800"), std::string_view::npos);
  *bytes_ = original;
  put_u32(*bytes_, layout::kNanoseconds, 1'000'000'000);
  EXPECT_EQ(check_bytes(), DecodeResult::kBadValue);
  // The radar's other messages on the same port are no faults.
  for (const auto method : {layout::kMethodObjectList, layout::kMethodFilterStatus}) {
    *bytes_ = original;
    (*bytes_)[2] = static_cast<std::uint8_t>(method >> 8);
    (*bytes_)[3] = static_cast<std::uint8_t>(method & 0xFF);
    EXPECT_EQ(check_bytes(), DecodeResult::kIgnored);
  }
}

TEST_F(Ars548Test, WithProtectionRequiredTheListIsCheckedAndItsCounterFollowed) {
  const e2e::Config protection{
      .profile = e2e::Profile::kP07, .data_id = 0x150, .offset_bytes = 8, .max_delta_counter = 3};
  Ars548 radar(E2eConfig{.required = true, .protection = protection});
  MemoryOutput out;
  recording::Frame frame;
  frame.kind = recording::FrameKind::kUdp;
  frame.payload = *bytes_;
  radar.take(frame, {}, out);
  EXPECT_EQ(out.scans, 0u) << "some firmware leaves the header at zero, which is rejected here";
  EXPECT_EQ(out.count(Fault::kWireValue), 1u);
  e2e::Protector protector(protection);
  for (std::uint32_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(protector.protect(std::span(*bytes_).subspan(8)));
    radar.take(frame, {}, out);
    EXPECT_EQ(out.scans, i + 1);
    EXPECT_EQ(out.scan->cycle_counter, i);
  }
  EXPECT_EQ(out.last_counter_bits, 32u);
  (*bytes_)[4000] ^= 1;
  radar.take(frame, {}, out);
  EXPECT_EQ(out.scans, 5u);
}

TEST(Ars548, ItsStatusIsPassedOn) {
  std::array<std::uint8_t, layout::kStatusBytes> status{};
  status[2] = layout::kMethodStatus >> 8;
  status[3] = layout::kMethodStatus & 0xFF;
  status[layout::status::kSyncStatus] = layout::kSyncOk;
  status[layout::status::kRadarState] = 1;
  status[layout::status::kBlockage] = 0x14;  // self-test passed, no blockage
  Ars548 radar;
  MemoryOutput out;
  recording::Frame frame;
  frame.kind = recording::FrameKind::kUdp;
  frame.payload = status;
  const auto conditions_after = [&](std::size_t at, std::uint8_t value) {
    auto changed = status;
    changed[at] = value;
    frame.payload = changed;
    radar.take(frame, {}, out);
    return *out.conditions;
  };
  radar.take(frame, {}, out);
  EXPECT_EQ(out.conditions, 0u);
  EXPECT_EQ(conditions_after(layout::status::kBlockage, 0x10), source_condition::kBlocked);
  EXPECT_EQ(conditions_after(layout::status::kBlockage, 0x13), source_condition::kPartlyBlocked);
  EXPECT_EQ(conditions_after(layout::status::kBlockage, 0x04), source_condition::kDefective);
  EXPECT_EQ(conditions_after(layout::status::kRadarState, 2), source_condition::kDefective);
  EXPECT_EQ(conditions_after(layout::status::kVoltage, 1), source_condition::kSupply);
  EXPECT_EQ(conditions_after(layout::status::kTemperature, 2), source_condition::kTemperature);
  EXPECT_EQ(conditions_after(layout::status::kSyncStatus, layout::kSyncLost), source_condition::kUnsynchronised);
  EXPECT_EQ(conditions_after(layout::status::kYawRateStatus, 1), source_condition::kWithoutEgoMotion);
  EXPECT_EQ(out.scans, 0u);
  EXPECT_EQ(out.all_faults(), 0u);
  frame.payload = std::span(status).first(80);
  radar.take(frame, {}, out);
  EXPECT_EQ(out.count(Fault::kWireLength), 1u);
}

TEST_F(Ars548Test, AnImplausibleDetectionIsFlaggedAndTheOthersStay) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  put_f32(*bytes_, record(0) + layout::record::kRange_m, nan);
  put_f32(*bytes_, record(1) + layout::record::kAzimuth_rad, 4.0F);
  put_f32(*bytes_, record(2) + layout::record::kRangeRate_mps, -200.0F);
  put_f32(*bytes_, record(3) + layout::record::kElevation_rad, 2.0F);
  put_f32(*bytes_, record(4) + layout::record::kRange_m, -1.0F);
  (*bytes_)[record(5) + layout::record::kInvalidFlags] = layout::invalid::kAzimuth;
  (*bytes_)[record(6) + layout::record::kInvalidFlags] = layout::invalid::kAzimuthStd;
  put_f32(*bytes_, record(7) + layout::record::kAzimuthStd_rad, nan);
  ASSERT_EQ(check_bytes(), DecodeResult::kComplete);
  static_cast<void>(decode(*bytes_, *scan_));
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(scan_->detection_flags[i], detection_flag::kUnusable) << i;
  EXPECT_EQ(scan_->detection_flags[5], detection_flag::kInvalid) << "the sensor's word";
  for (std::size_t i = 6; i < 300; ++i) EXPECT_FALSE(scan_->detection_flags[i] & detection_flag::kUntrusted) << i;
  EXPECT_EQ(scan_->azimuth_std_rad[6], 0.0F) << "not stated";
  EXPECT_EQ(scan_->azimuth_std_rad[7], 0.0F);
}

TEST_F(Ars548Test, RangeRatesOutsideTheUnambiguousIntervalAreMarked) {
  put_f32(*bytes_, layout::kRangeRateMin_mps, -10.0F);
  put_f32(*bytes_, layout::kRangeRateMax_mps, 10.0F);
  static_cast<void>(decode(*bytes_, *scan_));
  EXPECT_TRUE(scan_->has(scan_field::kAmbiguity));
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ((scan_->detection_flags[i] & detection_flag::kAmbiguous) != 0,
              std::abs(sent_->range_rate_mps[i]) > 10.0F);
  }
  put_f32(*bytes_, layout::kRangeRateMin_mps, 20.0F);  // an invalid interval
  static_cast<void>(decode(*bytes_, *scan_));
  EXPECT_FALSE(scan_->has(scan_field::kAmbiguity));
}

TEST_F(Ars548Test, TwentyThousandMutationsAreRefusedOrDecodedWithinBounds) {
  std::mt19937 random(2);
  std::uniform_int_distribution<std::size_t> place(0, bytes_->size() - 1), front(0, 120), edits(1, 8);
  std::uniform_int_distribution<int> byte(0, 255);
  const Ars548List original = *bytes_;
  std::size_t decoded = 0;
  for (int round = 0; round < 20'000; ++round) {
    *bytes_ = original;
    for (std::size_t n = edits(random); n > 0; --n) {
      (*bytes_)[round % 2 == 0 ? place(random) : front(random)] = static_cast<std::uint8_t>(byte(random));
    }
    std::span<const std::uint8_t> datagram = *bytes_;
    if (round % 5 == 0) datagram = datagram.first(place(random));
    if (check(datagram, problem_) != DecodeResult::kComplete) continue;
    ++decoded;
    static_cast<void>(decode(datagram, *scan_));
    ASSERT_LE(scan_->number_of_valid_detections, 800u);
    for (std::size_t i = 0; i < scan_->number_of_valid_detections; ++i) {
      if ((scan_->detection_flags[i] & detection_flag::kUnusable) != 0) continue;
      ASSERT_TRUE(scan_->range_m[i] >= 0.0F && scan_->range_m[i] <= 1500.0F);
      ASSERT_TRUE(std::abs(scan_->azimuth_rad[i]) <= 3.15F && std::abs(scan_->elevation_rad[i]) <= 1.58F);
      ASSERT_TRUE(std::abs(scan_->range_rate_mps[i]) <= 150.0F);
      ASSERT_TRUE(std::isfinite(scan_->azimuth_std_rad[i]) && scan_->azimuth_std_rad[i] >= 0.0F);
    }
  }
  EXPECT_GT(decoded, 5000u);
}

}  // namespace
}  // namespace boresight::ingest::ars548
