#include "services/alignment_estimator/core/memory/codec.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "services/common/e2e/crc.hpp"
#include "tests/unit/alignment_estimator/memory/example.hpp"

namespace boresight::alignment {
namespace {

std::vector<std::uint8_t> encoded(const Memory& memory, const Identity& identity) {
  MemoryBytes bytes;
  const std::size_t size = encode_memory(memory, identity, bytes);
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

/// Writes the right checksum for changed content.
void seal(std::vector<std::uint8_t>& bytes) {
  const std::uint32_t crc = e2e::crc32_p4({bytes.data(), bytes.size() - 4});
  for (std::size_t i = 0; i < 4; ++i) bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
}

MemoryVerdict verdict(const std::vector<std::uint8_t>& bytes, const Identity& identity) {
  Memory out;
  std::size_t rejected_radars = 0;
  return decode_memory(bytes, identity, out, rejected_radars);
}

void expect_same(const Memory::Radar& out, const Memory::Radar& in) {
  EXPECT_EQ(out.id, in.id);
  EXPECT_EQ(out.has_elevation, in.has_elevation);
  EXPECT_EQ(out.rotation_vehicle_rad, in.rotation_vehicle_rad);
  EXPECT_EQ(out.range_rate_scale, in.range_rate_scale);
  EXPECT_EQ(out.time_offset_s, in.time_offset_s);
  EXPECT_EQ(out.position_error_m, in.position_error_m);
  EXPECT_EQ(out.azimuth_curve_rad, in.azimuth_curve_rad);
  EXPECT_EQ(out.height_excess, in.height_excess);
  EXPECT_EQ(out.mirror_share, in.mirror_share);
  EXPECT_EQ(out.angle_noise_scale, in.angle_noise_scale);
  EXPECT_EQ(out.range_rate_noise_scale, in.range_rate_noise_scale);
  EXPECT_EQ(out.seconds_of_drive, in.seconds_of_drive);
  EXPECT_EQ(out.fluctuation_variance, in.fluctuation_variance);
  EXPECT_EQ(out.covariance, in.covariance);
}

void expect_same_vehicle(const Memory& out, const Memory& in) {
  EXPECT_EQ(out.boot, in.boot);
  EXPECT_EQ(out.since_boot_ns, in.since_boot_ns);
  EXPECT_EQ(out.speed_scale, in.speed_scale);
  EXPECT_EQ(out.yaw_rate_bias_radps, in.yaw_rate_bias_radps);
  EXPECT_EQ(out.yaw_rate_gain, in.yaw_rate_gain);
  EXPECT_EQ(out.slip_coefficient_radps2pm, in.slip_coefficient_radps2pm);
  EXPECT_EQ(out.pitch_per_acceleration_radps2pm, in.pitch_per_acceleration_radps2pm);
  EXPECT_EQ(out.time_offset_s, in.time_offset_s);
  EXPECT_EQ(out.load_pitch_rad, in.load_pitch_rad);
  EXPECT_EQ(out.fluctuation_variance, in.fluctuation_variance);
  EXPECT_EQ(out.correlation_s, in.correlation_s);
  EXPECT_EQ(out.covariance, in.covariance);
}

TEST(MemoryCodec, RoundTripForOneToSixteenRadars) {
  for (const std::size_t radars : {1u, 4u, 16u}) {
    const Identity identity = identity_of(example_vehicle(radars));
    const Memory memory = example_memory(radars);
    const auto bytes = encoded(memory, identity);
    ASSERT_FALSE(bytes.empty());
    Memory out;
    std::size_t rejected_radars = 99;
    ASSERT_EQ(decode_memory(bytes, identity, out, rejected_radars), MemoryVerdict::kTaken);
    EXPECT_EQ(rejected_radars, 0u);
    expect_same_vehicle(out, memory);
    ASSERT_EQ(out.number_of_radars, radars);
    for (std::size_t i = 0; i < radars; ++i) expect_same(out.radars[i], memory.radars[i]);
  }
  EXPECT_EQ(encoded(example_memory(16), identity_of(example_vehicle(16))).size(), kMaxMemoryBytes);
}

TEST(MemoryCodec, EveryCutAndEveryFlippedBitIsRefused) {
  const Identity identity = identity_of(example_vehicle(2));
  const auto bytes = encoded(example_memory(2), identity);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_EQ(verdict({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}, identity),
              MemoryVerdict::kCorrupt)
        << length;
  }
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto changed = bytes;
    changed[bit / 8] = static_cast<std::uint8_t>(changed[bit / 8] ^ (1u << (bit % 8)));
    EXPECT_EQ(verdict(changed, identity), MemoryVerdict::kCorrupt) << bit;
  }
  auto longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(verdict(longer, identity), MemoryVerdict::kCorrupt);
}

TEST(MemoryCodec, NoiseIsRefusedWithAndWithoutARightChecksum) {
  const Identity identity = identity_of(example_vehicle(2));
  const auto bytes = encoded(example_memory(2), identity);
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    // Random content with a right checksum: a bug elsewhere, or an attack.
    auto changed = bytes;
    const std::size_t first = i % 2 == 0 ? 16 : kMemoryHeaderBytes;
    for (int k = 0; k <= i % 7; ++k) {
      changed[first + random() % (changed.size() - 4 - first)] = static_cast<std::uint8_t>(random());
    }
    seal(changed);
    Memory out;
    std::size_t rejected_radars = 0;
    if (decode_memory(changed, identity, out, rejected_radars) != MemoryVerdict::kTaken) continue;
    ASSERT_LE(out.number_of_radars, kMaxRadars);
    ASSERT_TRUE(std::isfinite(out.speed_scale));
    for (std::size_t k = 0; k < Memory::kShared; ++k) ASSERT_GE(out.variance(k, k), 0.0);
    for (std::size_t r = 0; r < out.number_of_radars; ++r) {
      for (std::size_t k = 0; k < Memory::kOwn; ++k) ASSERT_GE(out.radars[r].variance(k, k), 0.0);
    }
  }
}

TEST(MemoryCodec, AnotherVersionIsDistinguishedFromDamage) {
  const Identity identity = identity_of(example_vehicle(2));
  for (const std::uint32_t version : {kMemoryVersion - 1, kMemoryVersion + 1}) {
    auto bytes = encoded(example_memory(2), identity);
    bytes[8] = static_cast<std::uint8_t>(version);
    seal(bytes);
    EXPECT_EQ(verdict(bytes, identity), MemoryVerdict::kOtherVersion);
  }
}

TEST(MemoryCodec, AnotherVehicleIsForeign) {
  VehicleConfig other = example_vehicle(2);
  other.name = "other";
  const auto bytes = encoded(example_memory(2), identity_of(example_vehicle(2)));
  EXPECT_EQ(verdict(bytes, identity_of(other)), MemoryVerdict::kForeign);
}

TEST(MemoryCodec, OnlyTheRemountedRadarIsRejected) {
  const Memory memory = example_memory(4);
  const auto bytes = encoded(memory, identity_of(example_vehicle(4)));
  std::vector<VehicleConfig> changed(5, example_vehicle(4));
  changed[0].radars[1].mounting_pose.yaw_rad += 1e-9;
  changed[1].radars[1].mounting_pose.position_m[2] = 0.6;
  changed[2].radars[1].profile = RadarProfile::kSrr520;
  changed[3].radars[1].mapping = "another.toml";
  changed[4].radars.erase(changed[4].radars.begin() + 1);
  for (const VehicleConfig& vehicle : changed) {
    Memory out;
    std::size_t rejected_radars = 0;
    ASSERT_EQ(decode_memory(bytes, identity_of(vehicle), out, rejected_radars), MemoryVerdict::kTaken);
    EXPECT_EQ(rejected_radars, 1u);
    ASSERT_EQ(out.number_of_radars, 3u);
    expect_same(out.radars[0], memory.radars[0]);
    expect_same(out.radars[1], memory.radars[2]);
    expect_same(out.radars[2], memory.radars[3]);
    expect_same_vehicle(out, memory);
  }
}

TEST(MemoryCodec, ImplausibleStatesAreRefused) {
  const Identity identity = identity_of(example_vehicle(2));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Memory> wrong(13, example_memory(2));
  wrong[0].speed_scale = nan;
  wrong[1].speed_scale = -1.0;
  wrong[2].radars[1].rotation_vehicle_rad[2] = std::numeric_limits<double>::infinity();
  wrong[3].radars[0].angle_noise_scale = 0.0;
  wrong[4].covariance[0] = 0.0;                             // not estimated, but correlated
  wrong[5].variance(0, 1) = wrong[5].variance(1, 0) = 1.0;  // a correlation beyond 1
  wrong[6].radars[0].rotation_variance(1, 1) = nan;
  wrong[7].radars[1].seconds_of_drive = -1.0;
  wrong[8].radars[1].variance(3, 4) = wrong[8].radars[1].variance(4, 3) = 1.0;
  wrong[9].radars[0].fluctuation_variance[1] = -1e-6;
  wrong[10].correlation_s[0] = nan;
  wrong[11].radars[1].azimuth_curve_rad[4] = 1.0;
  wrong[12].load_pitch_rad = 2.0;
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_EQ(verdict(encoded(wrong[i], identity), identity), MemoryVerdict::kImplausible) << i;
  }
}

TEST(MemoryCodec, ParametersThatAMethodDoesNotEstimateHaveNoVariance) {
  const Identity identity = identity_of(example_vehicle(1));
  Memory memory;
  memory.number_of_radars = 1;
  memory.radars[0].id = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) memory.radars[0].rotation_variance(axis, axis) = 1e-6;
  EXPECT_EQ(verdict(encoded(memory, identity), identity), MemoryVerdict::kTaken);
}

TEST(MemoryCodec, ARadarOfAnotherVehicleIsNotWritten) {
  Memory memory = example_memory(2);
  memory.radars[1].id = 7;
  EXPECT_TRUE(encoded(memory, identity_of(example_vehicle(2))).empty());
  memory = example_memory(2);
  memory.number_of_radars = 17;
  EXPECT_TRUE(encoded(memory, identity_of(example_vehicle(2))).empty());
}

}  // namespace
}  // namespace boresight::alignment
