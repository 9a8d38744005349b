// The filter that is chosen by name: names, refusals, steps back, a moving origin, copies, no allocation.
#include <cmath>
#include <limits>
#include <type_traits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/tracker/core/filters/motion_filter.hpp"
#include "tests/unit/tracker/filters_support.hpp"

namespace boresight::tracking::filters {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
const Eigen::Matrix2d kSmall_m2 = 0.1 * Eigen::Matrix2d::Identity();
const Eigen::Vector2d kOrigin = Eigen::Vector2d::Zero();

MotionState some_state() {
  MotionState state;
  state.mean << 20.0, 5.0, 0.4, -4.0, 1.0, -0.1;
  state.covariance.diagonal() << 1.0, 2.0, 1.0, 1.5, 2.5, 1.0;
  state.covariance(1, 0) = state.covariance(0, 1) = 0.5;
  return state;
}

ProcessNoise fading_noise() {
  ProcessNoise noise;
  noise.acceleration_decay_s = 2.0;
  return noise;
}

void expect_same(const MotionState& a, const MotionState& b, double tolerance, std::string_view name) {
  EXPECT_LE((a.mean - b.mean).cwiseAbs().maxCoeff(), tolerance) << name;
  EXPECT_LE((a.covariance - b.covariance).cwiseAbs().maxCoeff(), tolerance) << name;
}

class MotionFilterOfEachKind : public ::testing::TestWithParam<std::string_view> {
 protected:
  [[nodiscard]] MotionFilter make(const MotionState& state = some_state()) const {
    return {*filter_kind(GetParam()), state};
  }
};
INSTANTIATE_TEST_SUITE_P(Kinds, MotionFilterOfEachKind, ::testing::ValuesIn(filter_kind_names()),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(MotionFilterOfEachKind, HasItsName) {
  EXPECT_EQ(name_of(make().kind()), GetParam());
  expect_same(make().state(), some_state(), 1e-14, GetParam());
}

TEST_P(MotionFilterOfEachKind, FollowsAnObjectThatTurnsAndBrakes) {
  MotionFilter filter = make();
  const Eigen::Vector2d sensor(3.0, 1.0);
  double worst_m = 0.0;
  for (int k = 1; k <= 200; ++k) {
    const double t = 0.05 * k;
    const Eigen::Vector2d place(20.0 + 5.0 * t - 0.2 * t * t, -4.0 + t + 2.0 * std::sin(0.4 * t));
    const Eigen::Vector2d velocity(5.0 - 0.4 * t, 1.0 + 0.8 * std::cos(0.4 * t));
    const Eigen::Vector2d line = (place - sensor).normalized();
    ASSERT_TRUE(filter.predict(0.05, fading_noise()));
    ASSERT_TRUE(filter.update(place, kSmall_m2, RangeRate{line, line.dot(velocity), 0.01}, sensor));
    const MotionState state = filter.state();
    if (k > 50) worst_m = std::max(worst_m, std::hypot(state.mean(0) - place.x(), state.mean(3) - place.y()));
  }
  EXPECT_LT(worst_m, 0.1);
}

TEST_P(MotionFilterOfEachKind, StepBackUndoesAStepWithoutNoise) {
  MotionFilter filter = make();
  ProcessNoise noise = fading_noise();
  noise.jerk_density_m2ps5 = 0.0;
  ASSERT_TRUE(filter.predict(0.3, noise));
  ASSERT_TRUE(filter.predict(-0.3, noise));
  expect_same(filter.state(), some_state(), 1e-12, GetParam());
  ASSERT_TRUE(filter.predict(0.0, fading_noise()));
  expect_same(filter.state(), some_state(), 1e-12, GetParam());
}

TEST_P(MotionFilterOfEachKind, StepBackAddsNoNoise) {
  MotionFilter filter = make(), other = make();
  ProcessNoise strong = fading_noise();
  strong.jerk_density_m2ps5 = 50.0;
  ASSERT_TRUE(filter.predict(-0.2, fading_noise()));
  ASSERT_TRUE(other.predict(-0.2, strong));
  expect_same(filter.state(), other.state(), 0.0, GetParam());
}

TEST_P(MotionFilterOfEachKind, MovesWithTheOriginOfItsAxes) {
  MotionFilter filter = make(), moved = make();
  const Eigen::Vector2d displacement(1.5, -0.4), place(20.5, -3.8), sensor(1.0, 0.5);
  const RangeRate range_rate{(place - sensor).normalized(), 4.0, 0.05};
  ASSERT_TRUE(moved.shift(displacement));
  ASSERT_TRUE(filter.update(place, kSmall_m2, range_rate, sensor));
  ASSERT_TRUE(moved.update(place - displacement, kSmall_m2, range_rate, sensor - displacement));
  ASSERT_TRUE(moved.shift(-displacement));
  expect_same(filter.state(), moved.state(), 1e-11, GetParam());
}

TEST_P(MotionFilterOfEachKind, AcceptsAPlaceWithoutRangeRate) {
  MotionFilter filter = make();
  ASSERT_TRUE(filter.update({21.0, -4.0}, kSmall_m2, std::nullopt, kOrigin));
  const MotionState state = filter.state();
  EXPECT_NEAR(state.mean(0), 20.9, 0.05);
  EXPECT_LT(state.covariance(0, 0), 0.1);
  // The velocity is correlated with the place.
  EXPECT_GT(state.mean(1), 5.2);
}

TEST_P(MotionFilterOfEachKind, TakesAVelocityAsTheKalmanFilterDoes) {
  MotionFilter filter = make(), kalman(FilterKind::kKalman, some_state());
  Eigen::Matrix2d covariance;
  covariance << 0.5, 0.2, 0.2, 0.3;
  ASSERT_TRUE(filter.update_velocity({6.0, 0.5}, covariance));
  ASSERT_TRUE(kalman.update_velocity({6.0, 0.5}, covariance));
  expect_same(filter.state(), kalman.state(), 1e-12, GetParam());
}

TEST_P(MotionFilterOfEachKind, RefusesWhatIsNotFiniteOrNotPositiveDefiniteAndKeepsItsState) {
  MotionFilter filter = make();
  Eigen::Matrix2d indefinite, not_finite = kSmall_m2;
  indefinite << 0.1, 0.2, 0.2, 0.1;
  not_finite(0, 0) = kNotANumber;
  const Eigen::Vector2d place(20.0, -4.0), nowhere(kNotANumber, 0.0);
  const RangeRate good{{1.0, 0.0}, 5.0, 0.01};
  EXPECT_FALSE(filter.update(nowhere, kSmall_m2, good, kOrigin));
  EXPECT_FALSE(filter.update(place, indefinite, good, kOrigin));
  EXPECT_FALSE(filter.update(place, not_finite, good, kOrigin));
  EXPECT_FALSE(filter.update(place, Eigen::Matrix2d::Zero(), good, kOrigin));
  EXPECT_FALSE(filter.update(place, kSmall_m2, RangeRate{{1.0, 0.0}, kNotANumber, 0.01}, kOrigin));
  EXPECT_FALSE(filter.update(place, kSmall_m2, RangeRate{{1.0, 0.0}, 5.0, 0.0}, kOrigin));
  EXPECT_FALSE(filter.update(place, kSmall_m2, RangeRate{{1.0, 0.0}, 5.0, -1.0}, kOrigin));
  EXPECT_FALSE(filter.update(place, kSmall_m2, RangeRate{{kNotANumber, 0.0}, 5.0, 0.01}, kOrigin));
  EXPECT_FALSE(filter.update(place, kSmall_m2, good, nowhere));
  EXPECT_FALSE(filter.update_velocity(nowhere, kSmall_m2));
  EXPECT_FALSE(filter.update_velocity({1.0, 0.0}, indefinite));
  EXPECT_FALSE(filter.predict(kNotANumber, fading_noise()));
  EXPECT_FALSE(filter.predict(std::numeric_limits<double>::infinity(), fading_noise()));
  ProcessNoise negative;
  negative.jerk_density_m2ps5 = -1.0;
  EXPECT_FALSE(filter.predict(0.1, negative));
  EXPECT_FALSE(filter.shift(nowhere));
  MotionState broken = some_state();
  broken.covariance(2, 2) = -1.0;
  EXPECT_FALSE(filter.set_state(broken));
  broken = some_state();
  broken.mean(1) = kNotANumber;
  EXPECT_FALSE(filter.set_state(broken));
  expect_same(filter.state(), make().state(), 0.0, GetParam());
  EXPECT_TRUE(filter.update(place, kSmall_m2, good, kOrigin));
}

TEST_P(MotionFilterOfEachKind, SurvivesATargetAtTheSensor) {
  MotionState at_sensor = some_state();
  at_sensor.mean(0) = at_sensor.mean(3) = 0.0;
  MotionFilter filter = make(at_sensor);
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1e-200, 0.0), Eigen::Vector2d(0.3, 0.2)}) {
    const MotionState before = filter.state();
    const bool is_used = filter.update(place, kSmall_m2, RangeRate{{1.0, 0.0}, 2.0, 0.01}, kOrigin);
    const MotionState after = filter.state();
    if (!is_used) expect_same(before, after, 0.0, GetParam());
    EXPECT_TRUE(after.mean.allFinite());
    EXPECT_EQ(after.covariance.llt().info(), Eigen::Success);
  }
}

TEST_P(MotionFilterOfEachKind, StaysPositiveDefiniteWithExactMeasurements) {
  MotionFilter filter = make();
  for (int k = 0; k < 500; ++k) {
    ASSERT_TRUE(filter.predict(0.05, fading_noise()));
    const Eigen::Vector2d place(20.0 + 0.25 * k, -4.0 + 0.05 * k);
    // A millimetre, and a millimetre in a second.
    const bool is_used =
        filter.update(place, 1e-6 * Eigen::Matrix2d::Identity(),
                      RangeRate{place.normalized(), place.normalized().dot(Eigen::Vector2d(5.0, 1.0)), 1e-6}, kOrigin);
    ASSERT_TRUE(is_used) << k;
    ASSERT_EQ(filter.state().covariance.llt().info(), Eigen::Success) << k;
  }
}

TEST_P(MotionFilterOfEachKind, IsInvalidWithoutAPositiveDefiniteCovariance) {
  MotionState broken = some_state();
  broken.covariance(3, 3) = 0.0;
  MotionFilter filter = make(broken);
  EXPECT_FALSE(filter.is_valid());
  EXPECT_FALSE(filter.predict(0.1, fading_noise()));
  EXPECT_FALSE(filter.shift({1.0, 0.0}));
  EXPECT_TRUE(filter.set_state(some_state()));
  EXPECT_TRUE(filter.is_valid());
  EXPECT_TRUE(filter.predict(0.1, fading_noise()));
  EXPECT_EQ(name_of(filter.kind()), GetParam());
}

TEST_P(MotionFilterOfEachKind, IsCopiedAsAValue) {
  MotionFilter filter = make();
  const MotionFilter copy = filter;
  ASSERT_TRUE(filter.predict(1.0, fading_noise()));
  expect_same(copy.state(), make().state(), 0.0, GetParam());
  MotionFilter other(FilterKind::kKalman, MotionState{});
  other = copy;
  EXPECT_EQ(other.kind(), copy.kind());
}

TEST_P(MotionFilterOfEachKind, DoesNotAllocate) {
  MotionFilter filter = make();
  const runtime::CountAllocations count;
  const std::uint64_t before = runtime::counted_allocations();
  MotionFilter copy = filter;
  bool succeeds = true;
  for (int k = 0; k < 10; ++k) {
    succeeds = succeeds && copy.predict(0.05, fading_noise()) && copy.shift({0.1, 0.0}) &&
               copy.update({20.0, -4.0}, kSmall_m2, RangeRate{{1.0, 0.0}, 5.0, 0.01}, kOrigin) &&
               copy.update({20.0, -4.0}, kSmall_m2, std::nullopt, kOrigin) &&
               copy.update_velocity({5.0, 1.0}, kSmall_m2) && copy.set_state(copy.state());
  }
  const std::uint64_t after = runtime::counted_allocations();
  EXPECT_TRUE(succeeds);
  EXPECT_EQ(after, before);
}

TEST(MotionFilter, IsAValueThatCanBeCopied) {
  EXPECT_TRUE(std::is_trivially_destructible_v<MotionFilter>);
  EXPECT_TRUE(std::is_copy_assignable_v<MotionFilter>);
}

TEST(MotionFilter, KnowsItsNames) {
  EXPECT_EQ(filter_kind("fast_srukf"), FilterKind::kFastSquareRootUnscented);
  EXPECT_EQ(filter_kind("kalman"), FilterKind::kKalman);
  EXPECT_EQ(filter_kind("pmbm"), std::nullopt);
  EXPECT_EQ(filter_kind(""), std::nullopt);
  EXPECT_EQ(filter_kind_names().size(), 5U);
}

TEST(MotionFilter, RefusesSigmaPointsWithoutSpread) {
  for (const SigmaPointParameters& parameters :
       {SigmaPointParameters{0.0, 2.0, 0.0}, SigmaPointParameters{1.0, 2.0, -6.0},
        SigmaPointParameters{kNotANumber, 2.0, 0.0}}) {
    EXPECT_FALSE(MotionFilter(FilterKind::kUnscented, some_state(), parameters).is_valid());
  }
}

TEST(SquareRootUnscented, ReportsTheLossOfDefiniteness) {
  // Downdates with a weight that sigma points far from normal give: the covariance would be negative.
  Gaussian<double, 6> start;
  start.mean << 0.3, 0.0, 0.0, 0.0, 0.0, 0.0;
  SquareRootUnscented<double, 6> filter(start, SigmaPointParameters{1.0, -40.0, 0.0});
  const PolarMeasurement<double> sensor;
  EXPECT_FALSE(filter.update(sensor, Vector<double, 3>(0.3, 0.0, 0.0), independent_noise<double, 3>({0.1, 0.1, 0.1})));
}

}  // namespace
}  // namespace boresight::tracking::filters
