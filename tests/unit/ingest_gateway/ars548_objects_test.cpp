#include "services/ingest_gateway/codecs/ars548_objects.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/simulator/wire/byte_writer.hpp"

namespace boresight::ingest::ars548 {
namespace {

namespace layout = wire::ars548;
namespace field = layout::object;
using simulator::wire::put_f32;
using simulator::wire::put_u16;
using simulator::wire::put_u32;

class Ars548ObjectsTest : public testing::Test {
 protected:
  /// A list of `count` objects, object i at (i, −i) m, in a datagram of `bytes`.
  void make(std::size_t bytes, std::uint8_t count) {
    bytes_.assign(bytes, 0);
    put_u16(bytes_, 2, layout::kMethodObjectList);
    put_u32(bytes_, 4, static_cast<std::uint32_t>(bytes - 8));
    put_u32(bytes_, layout::kNanoseconds, 123'456'789);
    put_u32(bytes_, layout::kSeconds, 1'700'000'000);
    bytes_[layout::kSyncStatus] = layout::kSyncOk;
    bytes_[layout::kNumberOfObjects] = count;
    for (std::size_t i = 0; i < count; ++i) {
      put_u32(bytes_, at(i, field::kId), static_cast<std::uint32_t>(100'000 + i));
      put_f32(bytes_, at(i, field::kX_m), static_cast<float>(i));
      put_f32(bytes_, at(i, field::kY_m), -static_cast<float>(i));
      put_f32(bytes_, at(i, field::kExistence_percent), 75.0F);
      bytes_[at(i, field::kClasses_percent) + static_cast<std::size_t>(ObjectClass::kBicycle)] = 60;
      put_f32(bytes_, at(i, field::kLength_m), 4.5F);
    }
  }
  static std::size_t at(std::size_t i, std::size_t offset) {
    return layout::kObjects + i * layout::kObjectBytes + offset;
  }
  DecodeResult check() { return check_objects(bytes_, problem_); }

  std::vector<std::uint8_t> bytes_;
  std::unique_ptr<ObjectList> list_ = std::make_unique<ObjectList>();
  std::string_view problem_;
};

TEST_F(Ars548ObjectsTest, BothLengthsAreDecoded) {
  for (const auto& [bytes, count] : {std::pair<std::size_t, std::uint8_t>{layout::kObjectListBytes, 50},
                                     std::pair<std::size_t, std::uint8_t>{layout::kLongObjectListBytes, 200}}) {
    make(bytes, count);
    ASSERT_EQ(check(), DecodeResult::kComplete);
    decode_objects(bytes_, *list_);
    EXPECT_EQ(list_->time.time_ns, 1'700'000'000'123'456'789);
    ASSERT_EQ(list_->number_of_objects, count);
    for (std::size_t i = 0; i < count; ++i) {
      const Object& o = list_->objects[i];
      EXPECT_TRUE(o.valid) << i;
      EXPECT_EQ(o.id, 100'000u + i);
      EXPECT_EQ(o.x_m, static_cast<float>(i));
      EXPECT_EQ(o.y_m, -static_cast<float>(i));
      EXPECT_NEAR(o.existence_probability, 0.75, 1e-6);
      EXPECT_NEAR(o.class_probability[static_cast<std::size_t>(ObjectClass::kBicycle)], 0.6, 1e-6);
      EXPECT_EQ(o.length_m, 4.5F);
    }
  }
}

TEST_F(Ars548ObjectsTest, WrongLengthsCountsAndHeadersAreRefusedWithAReason) {
  make(layout::kObjectListBytes, 50);
  EXPECT_EQ(check_objects(std::span(bytes_).first(7), problem_), DecodeResult::kBadLength);
  EXPECT_EQ(check_objects(std::span(bytes_).first(9400), problem_), DecodeResult::kBadLength);
  EXPECT_NE(problem_.find("9401"), std::string_view::npos);
  bytes_[layout::kNumberOfObjects] = 51;
  EXPECT_EQ(check(), DecodeResult::kBadValue);
  make(layout::kLongObjectListBytes, 200);
  bytes_[layout::kNumberOfObjects] = 201;
  EXPECT_EQ(check(), DecodeResult::kBadValue);
  make(layout::kObjectListBytes, 1);
  bytes_[7] = static_cast<std::uint8_t>(bytes_[7] + 1);
  EXPECT_EQ(check(), DecodeResult::kBadLength);
  make(layout::kObjectListBytes, 1);
  put_u32(bytes_, layout::kNanoseconds, 1'000'000'000);
  EXPECT_EQ(check(), DecodeResult::kBadValue);
  put_u16(bytes_, 2, layout::kMethodDetectionList);
  EXPECT_EQ(check(), DecodeResult::kUnknownMessage);
}

TEST_F(Ars548ObjectsTest, AnImplausibleObjectIsMarkedAndTheOthersStay) {
  make(layout::kObjectListBytes, 20);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  put_f32(bytes_, at(0, field::kX_m), nan);
  put_f32(bytes_, at(1, field::kY_m), 1601.0F);
  put_f32(bytes_, at(2, field::kXStd_m), -1.0F);
  put_f32(bytes_, at(3, field::kOrientation_rad), 3.2F);
  put_f32(bytes_, at(4, field::kExistence_percent), 101.0F);
  bytes_[at(5, field::kClasses_percent)] = 101;
  bytes_[at(6, field::kMeasurementStatus)] = 255;
  bytes_[at(7, field::kPositionReference)] = 8;
  put_u16(bytes_, at(8, field::kPositionInvalid), 0x0100);
  bytes_[at(9, field::kMovementStatus)] = 255;
  bytes_[at(10, field::kRelativeVelocity_mps)] = 1;
  put_f32(bytes_, at(11, field::kAbsoluteVelocity_mps + 5), -0.1F);
  bytes_[at(12, field::kLengthInvalid)] = 1;
  put_f32(bytes_, at(13, field::kOrientationRate_radps), nan);
  ASSERT_EQ(check(), DecodeResult::kComplete);
  decode_objects(bytes_, *list_);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(list_->objects[i].valid, i >= 9) << i;
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(list_->objects[i].relative_velocity_mps.valid, i != 10) << i;
  EXPECT_FALSE(list_->objects[11].absolute_velocity_mps.valid);
  EXPECT_EQ(list_->objects[12].length_m, 0.0F) << "not stated";
  EXPECT_EQ(list_->objects[13].orientation_rate_radps, 0.0F);
}

TEST_F(Ars548ObjectsTest, MutationsAreRefusedOrDecodedWithinBounds) {
  std::mt19937 random(3);
  make(layout::kObjectListBytes, 50);
  const std::vector<std::uint8_t> original = bytes_;
  std::uniform_int_distribution<std::size_t> place(0, original.size() - 1), edits(1, 40);
  std::uniform_int_distribution<int> byte(0, 255);
  std::size_t decoded = 0;
  for (int round = 0; round < 5'000; ++round) {
    bytes_ = original;
    for (std::size_t n = edits(random); n > 0; --n) bytes_[place(random)] = static_cast<std::uint8_t>(byte(random));
    if (round % 5 == 0) bytes_.resize(place(random));
    if (check() != DecodeResult::kComplete) continue;
    ++decoded;
    decode_objects(bytes_, *list_);
    ASSERT_LE(list_->number_of_objects, 50u);
    for (std::size_t i = 0; i < list_->number_of_objects; ++i) {
      const Object& o = list_->objects[i];
      ASSERT_TRUE(std::isfinite(o.length_m) && std::isfinite(o.width_m) && std::isfinite(o.orientation_rate_radps));
      if (!o.valid) continue;
      ASSERT_TRUE(std::abs(o.x_m) <= 1600.0F && std::abs(o.y_m) <= 1600.0F && std::abs(o.z_m) <= 1600.0F);
      ASSERT_TRUE(o.x_std_m >= 0.0F && std::abs(o.orientation_rad) <= 3.15F);
      ASSERT_TRUE(o.existence_probability >= 0.0F && o.existence_probability <= 1.0F);
    }
  }
  EXPECT_GT(decoded, 1'000u);
}

}  // namespace
}  // namespace boresight::ingest::ars548
