#include "services/alignment_estimator/core/kpi/convergence.hpp"

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::alignment {
namespace {

constexpr double kCycle_s = 0.05;

/// Yaw moves by `distance` as 1 − exp(−t/τ); the other values are constant.
void drive(Convergence& convergence, double from_s, double to_s, double begin, double distance, double tau_s,
           std::uint32_t step_changes = 0) {
  const auto first = static_cast<int>(std::lround(from_s / kCycle_s)), last = static_cast<int>(to_s / kCycle_s);
  for (int i = first; i < last; ++i) {
    const double t = kCycle_s * (i + 1);
    const double yaw = begin + distance * (1.0 - std::exp(-(t - from_s - kCycle_s) / tau_s));
    convergence.add(t, static_cast<std::uint64_t>(i + 1), {1.0, yaw, 0.01, 0.0}, step_changes);
  }
}

TEST(Convergence, TimeTo95PercentOfAnExponential) {
  for (const double tau : {0.5, 4.0, 50.0}) {
    Convergence convergence;
    drive(convergence, 0.0, 40.0 * tau, 0.0, 0.03, tau);
    const auto settled = convergence.to_95_percent(AlignmentParameter::kYaw, 1e-4);
    EXPECT_NEAR(settled.seconds, tau * std::log(20.0), 0.03 * tau * std::log(20.0) + 2.0 * kCycle_s) << tau;
    EXPECT_NEAR(settled.scans, settled.seconds / kCycle_s, 2.0) << tau;
  }
}

TEST(Convergence, ADistanceThatMayBeNoiseHasNoTime) {
  Convergence convergence;
  EXPECT_TRUE(std::isnan(convergence.to_95_percent(AlignmentParameter::kYaw, 1e-4).seconds));
  drive(convergence, 0.0, 60.0, 0.0, 0.03, 3.0);
  EXPECT_TRUE(std::isnan(convergence.to_95_percent(AlignmentParameter::kYaw, 0.0061).seconds));
  EXPECT_FALSE(std::isnan(convergence.to_95_percent(AlignmentParameter::kYaw, 0.0059).seconds));
  EXPECT_TRUE(std::isnan(convergence.to_95_percent(AlignmentParameter::kPitch, 1e-9).seconds)) << "it did not move";
  EXPECT_EQ(convergence.to_95_percent(AlignmentParameter::kPitch, 1e-9).scans, 0u);
}

TEST(Convergence, AnExcursionDelaysTheTime) {
  Convergence convergence;
  drive(convergence, 0.0, 10.0, 0.0, 0.03, 0.1);
  drive(convergence, 10.0, 20.0, 0.01, 0.0, 1.0);  // an excursion of ten seconds
  drive(convergence, 20.0, 100.0, 0.03, 0.0, 1.0);
  EXPECT_NEAR(convergence.to_95_percent(AlignmentParameter::kYaw, 1e-4).seconds, 20.0, 0.5);
}

TEST(Convergence, AStepChangeStartsANewDistance) {
  Convergence convergence;
  drive(convergence, 0.0, 300.0, 0.0, 0.03, 2.0);
  drive(convergence, 300.0, 400.0, 0.03, 0.0175, 1.0, 1);
  EXPECT_NEAR(convergence.to_95_percent(AlignmentParameter::kYaw, 1e-4).seconds, std::log(20.0), 0.3);
}

TEST(Convergence, DriftOverTheLastMinute) {
  Convergence convergence;
  for (int i = 0; i < 20 * 59; ++i) {
    convergence.add(kCycle_s * i, static_cast<std::uint64_t>(i), {1.0, 1e-5 * i, 0.0, 0.0}, 0);
  }
  EXPECT_TRUE(std::isnan(convergence.drift_per_minute(AlignmentParameter::kYaw)));
  for (int i = 20 * 59; i < 20 * 1000; ++i) {
    convergence.add(kCycle_s * i, static_cast<std::uint64_t>(i), {1.0, 1e-5 * i, 0.0, 0.0}, 0);
  }
  EXPECT_NEAR(convergence.drift_per_minute(AlignmentParameter::kYaw), 1e-5 * 1200.0, 1e-7);
  EXPECT_EQ(convergence.drift_per_minute(AlignmentParameter::kSpeedScale), 0.0);
}

TEST(Convergence, YearsFitAndNothingIsAllocated) {
  Convergence convergence;
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    double t = 0.0;
    for (std::uint64_t i = 0; i < 200'000; ++i) {
      convergence.add(t, i, {1.0, t < 1.0 ? 0.0 : 0.03, 0.0, 0.0}, 0);
      t += kCycle_s + 1e-4 * t;  // growing intervals reach 24 million seconds with few scans
    }
    convergence.add(std::nan(""), 1, {1.0, 0.0, 0.0, 0.0}, 0);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_NEAR(convergence.to_95_percent(AlignmentParameter::kYaw, 1e-4).seconds, 1.0, 0.1);
}

}  // namespace
}  // namespace boresight::alignment
