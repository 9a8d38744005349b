#include "services/common/runtime/boot_time.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "services/common/runtime/clock.hpp"

namespace boresight::runtime {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(BootTime, CountsOnlyWithinABoot) {
  const BootTime then{7, 5 * kSecond_ns};
  EXPECT_DOUBLE_EQ(seconds_between(then, {7, 8 * kSecond_ns}), 3.0);
  EXPECT_DOUBLE_EQ(seconds_between(then, then), 0.0);
  EXPECT_TRUE(std::isinf(seconds_between(then, {8, 8 * kSecond_ns}))) << "booted in between";
  EXPECT_TRUE(std::isinf(seconds_between(then, {7, 4 * kSecond_ns}))) << "before it was written";
  EXPECT_TRUE(std::isinf(seconds_between({}, {0, kSecond_ns}))) << "not known";
}

TEST(BootTime, ThisMachineIsInOneBoot) {
  const BootTime then{boot_fingerprint(), since_boot_ns()};
  EXPECT_NE(then.boot, 0U);
  const double passed_s = seconds_between(then, {boot_fingerprint(), since_boot_ns()});
  EXPECT_GE(passed_s, 0.0);
  EXPECT_LT(passed_s, 60.0);
}

}  // namespace
}  // namespace boresight::runtime
