#include "tests/benchmarks/tracking/scenarios/common/lost_targets.hpp"

#include <gtest/gtest.h>

namespace boresight::bench::scenarios {
namespace {

track::ExtendedObject object_at(double x_m, std::uint32_t id = 0) {
  return {{{x_m, 0.0}, Eigen::Matrix2d::Identity()}, Eigen::Vector2d::Zero(), id};
}

/// One target over 20 steps with an estimate where `has_estimate` says.
template <typename Has>
LostTargets count_with(Has&& has_estimate) {
  track::ObjectsByStep truth, estimates;
  for (std::size_t i = 0; i < 20; ++i) {
    truth.push_back({object_at(0.0, 1)});
    estimates.emplace_back();
    if (has_estimate(i)) estimates.back().push_back(object_at(1.0));
  }
  return count_lost_targets(truth, estimates);
}

TEST(LostTarget, IsWithoutEstimateForMoreThanFiveScans) {
  EXPECT_EQ(count_with([](std::size_t i) { return i < 5 || i > 9; }).lost, 0U) << "five scans";
  EXPECT_EQ(count_with([](std::size_t i) { return i < 5 || i > 10; }).lost, 1U) << "six scans";
  EXPECT_EQ(count_with([](std::size_t i) { return i < 14; }).lost, 1U) << "the last six scans";
}

TEST(LostTarget, MustHaveBeenFoundBefore) {
  const LostTargets late = count_with([](std::size_t i) { return i > 12; });
  EXPECT_EQ(late.found, 1U);
  EXPECT_EQ(late.lost, 0U);
  const LostTargets never = count_with([](std::size_t) { return false; });
  EXPECT_EQ(never.targets, 1U);
  EXPECT_EQ(never.found, 0U);
  EXPECT_EQ(never.lost, 0U);
}

TEST(LostTarget, SharesNoEstimateWithAnother) {
  // Two targets beside each other and, from step 5 on, one estimate at the first.
  track::ObjectsByStep truth, estimates;
  for (std::size_t i = 0; i < 20; ++i) {
    truth.push_back({object_at(0.0, 1), object_at(2.0, 2)});
    estimates.push_back({object_at(0.0)});
    if (i < 5) estimates.back().push_back(object_at(2.0));
  }
  const LostTargets result = count_lost_targets(truth, estimates);
  EXPECT_EQ(result.found, 2U);
  EXPECT_EQ(result.lost, 1U);
}

TEST(LostTarget, HasNoEstimateBeyondTheCutOff) {
  track::ObjectsByStep truth, estimates;
  for (std::size_t i = 0; i < 20; ++i) {
    truth.push_back({object_at(0.0, 1)});
    estimates.push_back({object_at(i < 5 ? 19.0 : 21.0)});
  }
  EXPECT_EQ(count_lost_targets(truth, estimates).lost, 1U);
}

}  // namespace
}  // namespace boresight::bench::scenarios
