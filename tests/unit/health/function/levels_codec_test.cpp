#include "services/health/core/function/levels_codec.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::health {
namespace {

VehicleConfig vehicle(double yaw_rad = 0.0, const char* name = "car") {
  VehicleConfig vehicle;
  vehicle.name = name;
  for (const std::uint32_t id : {1U, 2U}) {
    RadarConfig radar;
    radar.id = id;
    radar.mounting_pose.yaw_rad = id == 2 ? yaw_rad : 0.0;
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

VehicleLevels example() {
  VehicleLevels levels;
  levels.number_of_radars = 2;
  levels.radars[0] = {1, {{4.5, 0.1, 600.0}, {4.0, 0.2, 600.0}}, {2.0, 0.5, 300.0}};
  levels.radars[1] = {2, {{3.5, 0.3, 60.0}, {3.0, 0.4, 60.0}}, {1.0, 0.6, 30.0}};
  return levels;
}

class LevelsCodec : public testing::Test {
 protected:
  StoredLevels decode(const VehicleConfig& of, const Config& config = {}) {
    return decode_levels(bytes_, levels_identity_of(of, config), read_, rejected_);
  }
  void encode(const VehicleLevels& levels) {
    bytes_.resize(kMaxLevelsBytes);
    bytes_.resize(encode_levels(levels, levels_identity_of(vehicle(), {}), bytes_));
  }
  std::vector<std::uint8_t> bytes_;
  VehicleLevels read_;
  std::size_t rejected_ = 0;
};

TEST_F(LevelsCodec, GivesBackEveryLevel) {
  encode(example());
  ASSERT_EQ(decode(vehicle()), StoredLevels::kTaken);
  EXPECT_EQ(rejected_, 0u);
  ASSERT_EQ(read_.number_of_radars, 2u);
  EXPECT_EQ(read_.radars[1].radar_id, 2u);
  EXPECT_EQ(read_.radars[0].sight.log_count.mean, 4.5);
  EXPECT_EQ(read_.radars[0].sight.log_range.variance, 0.2);
  EXPECT_EQ(read_.radars[1].log_unexplained.learnt_s, 30.0);
}

TEST_F(LevelsCodec, ARadarThatWasTurnedSinceIsLeftOut) {
  encode(example());
  ASSERT_EQ(decode(vehicle(0.5)), StoredLevels::kTaken);
  EXPECT_EQ(rejected_, 1u);
  ASSERT_EQ(read_.number_of_radars, 1u);
  EXPECT_EQ(read_.radars[0].radar_id, 1u);
}

TEST_F(LevelsCodec, AnotherVehicleAndOtherQuantitiesAreRefusedWithTheirReason) {
  encode(example());
  EXPECT_STREQ(describe(decode(vehicle(0.0, "truck"))), "of another vehicle");
  Config config;
  config.sight.range_quantile = 0.8;
  EXPECT_STREQ(describe(decode(vehicle(), config)), "of another configuration");
  EXPECT_EQ(read_.number_of_radars, 0u);
}

TEST_F(LevelsCodec, EveryChangedByteAndEveryTruncationIsRefused) {
  encode(example());
  const std::vector<std::uint8_t> intact = bytes_;
  for (std::size_t i = 0; i < intact.size(); ++i) {
    bytes_ = intact;
    bytes_[i] ^= 1U;
    EXPECT_NE(decode(vehicle()), StoredLevels::kTaken) << i;
    bytes_ = intact;
    bytes_.resize(i);
    EXPECT_EQ(decode(vehicle()), StoredLevels::kCorrupt) << i;
  }
}

TEST_F(LevelsCodec, ImpossibleValuesAreRefused) {
  for (const StoredLevel& level :
       {StoredLevel{std::numeric_limits<double>::quiet_NaN(), 0.1, 1.0}, StoredLevel{1.0, -0.1, 1.0},
        StoredLevel{1.0, 0.1, -1.0}, StoredLevel{1e9, 0.1, 1.0}}) {
    VehicleLevels levels = example();
    levels.radars[0].sight.log_range = level;
    encode(levels);
    EXPECT_EQ(decode(vehicle()), StoredLevels::kCorrupt);
  }
}

TEST_F(LevelsCodec, ASmallBufferTakesNothing) {
  bytes_.resize(100);
  EXPECT_EQ(encode_levels(example(), levels_identity_of(vehicle(), {}), bytes_), 0u);
}

}  // namespace
}  // namespace boresight::health
