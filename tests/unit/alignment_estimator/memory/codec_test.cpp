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
    EXPECT_EQ(out.number_of_radars, radars);
    EXPECT_EQ(out.speed_scale, memory.speed_scale);
    EXPECT_EQ(out.slip_coefficient_radps2pm, memory.slip_coefficient_radps2pm);
    EXPECT_EQ(out.covariance, memory.covariance);
    for (std::size_t i = 0; i < radars; ++i) {
      EXPECT_EQ(out.radars[i].id, memory.radars[i].id);
      EXPECT_EQ(out.radars[i].rotation_vehicle_rad, memory.radars[i].rotation_vehicle_rad);
      EXPECT_EQ(out.radars[i].angle_noise_scale, 1.1);
      EXPECT_EQ(out.radars[i].seconds_of_drive, 1000.0);
    }
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
    const std::size_t n = out.number_of_parameters();
    for (std::size_t k = 0; k < n; ++k) ASSERT_GT(out.covariance[k * n + k], 0.0);
  }
}

TEST(MemoryCodec, AnotherVersionIsDistinguishedFromDamage) {
  const Identity identity = identity_of(example_vehicle(2));
  auto bytes = encoded(example_memory(2), identity);
  bytes[8] = 2;
  seal(bytes);
  EXPECT_EQ(verdict(bytes, identity), MemoryVerdict::kOtherVersion);
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
    EXPECT_EQ(out.radars[0].id, 1u);
    EXPECT_EQ(out.radars[1].id, 3u);
    EXPECT_EQ(out.radars[2].id, 4u);
    EXPECT_EQ(out.radars[1].rotation_vehicle_rad, memory.radars[2].rotation_vehicle_rad);
    // Rows 0…2 are shared, 3…5 of radar 1; those of radar 3 were 9…11 and are 6…8 now.
    const std::size_t n = 12, old_n = 15;
    ASSERT_EQ(out.number_of_parameters(), n);
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) {
        const std::size_t from_r = r < 6 ? r : r + 3, from_c = c < 6 ? c : c + 3;
        EXPECT_EQ(out.covariance[r * n + c], memory.covariance[from_r * old_n + from_c]) << r << ", " << c;
      }
    }
  }
}

TEST(MemoryCodec, ImplausibleStatesAreRefused) {
  const Identity identity = identity_of(example_vehicle(2));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Memory> wrong(8, example_memory(2));
  wrong[0].speed_scale = nan;
  wrong[1].speed_scale = -1.0;
  wrong[2].radars[1].rotation_vehicle_rad[2] = std::numeric_limits<double>::infinity();
  wrong[3].radars[0].angle_noise_scale = 0.0;
  wrong[4].covariance[0] = 0.0;
  wrong[5].covariance[1] = wrong[5].covariance[9] = 1.0;  // a correlation beyond 1
  wrong[6].covariance[4 * 9 + 4] = nan;
  wrong[7].radars[1].seconds_of_drive = -1.0;
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_EQ(verdict(encoded(wrong[i], identity), identity), MemoryVerdict::kImplausible) << i;
  }
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
