// The heading as a part of a vehicle's state.
#include "services/tracker/core/heading.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

KinematicState moving_at(const Eigen::Vector2d& velocity, double speed_std) {
  KinematicState s;
  s.mean.segment<2>(2) = velocity;
  s.covariance.block<2, 2>(2, 2) *= speed_std * speed_std;
  return s;
}

TEST(Heading, BeginsAsTheCourseOnceThatIsKnown) {
  KinematicState unsure = moving_at({3.0, 4.0}, 2.0), standing = moving_at({0.1, 0.0}, 0.01);
  begin_heading(unsure);
  EXPECT_FALSE(unsure.heading.known);
  begin_heading(standing);
  EXPECT_FALSE(standing.heading.known);
  KinematicState s = moving_at({3.0, 4.0}, 0.5);
  begin_heading(s);
  ASSERT_TRUE(s.heading.known);
  EXPECT_NEAR(s.heading.rad, std::atan2(4.0, 3.0), 1e-12);
  EXPECT_NEAR(s.heading.variance, 0.01 + 0.01, 1e-12) << "0.5 of 5 m/s, and some more";
}

TEST(Heading, DoesNotBeginAcrossTheLineOfSightByAVelocityThatMayBeNone) {
  // Ahead, 1.1 m/s by its range rate; and four across, give or take as much. Where the mean points to, a derivative by
  // the velocity would find the course sure to 0.25 rad.
  KinematicState s;
  s.mean.segment<2>(2) << 1.1, -4.0;
  s.covariance.block<2, 2>(2, 2) = Eigen::Vector2d(0.01, 12.0).asDiagonal();
  begin_heading(s);
  EXPECT_FALSE(s.heading.known);
  s.covariance(3, 3) = 0.25;
  begin_heading(s);
  EXPECT_TRUE(s.heading.known) << "it does go across";
}

/// How the box of the one track heads after each of so many scans, rad; `add` fills them.
template <typename Add>
std::vector<double> headings(int scans, const Add& add) {
  Tracker tracker(two_radars(), RulesConfig{});
  Scene scene;
  const auto list = std::make_unique<TrackList>();
  std::vector<double> found_rad;
  for (int i = 0; i < scans; ++i) {
    scene.begin((1000 + 50 * i) * kMillisecond);
    add(scene, i);
    tracker.step(*scene.scan);
    tracker.write(*list);
    EXPECT_GE(list->number_of_tracks, 1u) << i;
    EXPECT_LE(list->number_of_confirmed_tracks, 1u) << i;
    found_rad.push_back(static_cast<double>(list->tracks[0].heading_rad));
  }
  return found_rad;
}

double rms(std::span<const double> values) {
  double square = 0.0;
  for (const double value : values) square += value * value / static_cast<double>(values.size());
  return std::sqrt(square);
}

TEST(Heading, OfWhatCreepsFarAheadIsNotThatOfTheNoise) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> across_m(0.0, 0.8);
    const std::vector<double> found_rad = headings(40, [&](Scene& scene, int i) {
      scene.add({80.0 + 0.1 * i, 3.6 + across_m(random)}, {2.0, 0.0});
    });
    for (const double heading_rad : found_rad) EXPECT_NEAR(heading_rad, 0.0, 0.3) << seed;
  }
}

TEST(Heading, OfACarThatIsHeardLessFarAheadStays) {
  // Weaker than some cycles from then on: their boxes follow the course, which noise turns.
  constexpr int kNear = 60;  // scans
  std::mt19937_64 random(3);
  std::normal_distribution<double> across_m(0.0, 1.2);
  const std::vector<double> found_rad = headings(260, [&](Scene& scene, int i) {
    const bool is_far = i >= kNear;
    scene.scan->fields |= scan_field::kRcs;
    for (const double along_m : {0.0, 2.2}) {
      const std::uint32_t k = scene.scan->number_of_valid_detections;
      scene.add({60.0 + 0.1 * i + along_m, 2.7 + (is_far ? 1.0 : 0.1) * across_m(random)}, {2.0, 0.0});
      scene.scan->rcs_dbsm[k] = is_far ? 0.0F : 10.0F;
      if (is_far) scene.scan->azimuth_std_rad[k] = 0.02F;
    }
  });
  EXPECT_LT(rms(std::span(found_rad).subspan(kNear)), 0.08);
}

/// A range rate measured abeam, and the place hardly.
PositionRate rate_across(const KinematicState& state, double rate_mps) {
  PositionRate m;
  m.value << state.mean(0), state.mean(1), rate_mps;
  m.covariance = Eigen::Vector3d(1e4, 1e4, 0.01).asDiagonal();
  m.line_of_sight = {0.0, 1.0};
  return m;
}

TEST(Heading, TurnsWithTheVelocityAndTheVelocityWithIt) {
  KinematicState s = moving_at({10.0, 0.0}, 1.0);
  begin_heading(s);
  ASSERT_TRUE(update(s, rate_across(s, 0.5)));
  EXPECT_NEAR(s.heading.rad, 0.05, 0.005) << "0.5 of 10 m/s";
  const double across_mps = s.mean(3);
  measure_heading(s, {0.05, 1e-6});
  EXPECT_GT(s.mean(3), across_mps);
  KinematicState slipping = moving_at({10.0, 1.0}, 1.0);
  slipping.heading.known = true;
  slipping.heading.variance = 1e-4;
  hold_to_heading(slipping);
  EXPECT_LT(std::abs(slipping.mean(3)), 0.45) << "it does not go so far beside its heading";
  EXPECT_LT(slipping.covariance(3, 3), 0.5);
}

TEST(Heading, StaysOfWhoCreeps) {
  KinematicState creeping = moving_at({1.0, 0.0}, 0.1), driving = moving_at({10.0, 0.0}, 0.1);
  for (KinematicState* s : {&creeping, &driving}) {
    begin_heading(*s);
    const double before = s->heading.variance;
    predict_heading(*s, 0.05, 0.2);
    EXPECT_NEAR(s->heading.rad, -0.2, 1e-12) << "the vehicle frame has turned";
    s->heading.variance -= before;
  }
  EXPECT_LT(creeping.heading.variance, 0.2 * driving.heading.variance);
}

TEST(Heading, ComingToRestDoesNotTurn) {
  KinematicState s = moving_at({1.0, 0.4}, 0.1);
  begin_heading(s);
  const double before = s.heading.rad;
  come_to_rest(s);
  EXPECT_EQ(s.heading.rad, before);
}

TEST(RangeRate, OfALongBodyNearbyIsThatOfTheMeanOfItsDirections) {
  Scene scene;
  scene.begin(kMillisecond);
  const Eigen::Vector2d velocity(0.4, 0.0);  // so slow that none of it looks like a wheel
  for (const double x : {3.0, 5.0, 7.0, 9.0}) scene.add({x, -2.0}, velocity);
  Clusterer clusterer{RulesConfig{}};
  const auto clusters = clusterer.find(*scene.scan);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_NEAR(clusters[0].mean_sight.dot(velocity), clusters[0].range_rate_over_ground_mps, 1e-6);
  EXPECT_GT(std::abs(clusters[0].line_of_sight.dot(velocity) - clusters[0].range_rate_over_ground_mps), 0.03);
}

TEST(Heading, BeginsAlongAFlankIfTheCourseIsNotKnown) {
  KinematicState s = moving_at({1.0, 0.5}, 2.0);
  begin_heading(s, 0.3, {-0.3, 0.004});
  ASSERT_TRUE(s.heading.known);
  EXPECT_NEAR(s.heading.rad, 0.0, 1e-12);
  EXPECT_EQ(s.heading.variance, 0.004);
  KinematicState across = moving_at({-0.1, 1.0}, 2.0);
  begin_heading(across, 0.3, {-0.3, 0.004});
  EXPECT_FALSE(across.heading.known) << "it goes the other way";
}

/// A truck creeps ahead, its flank seen from the lane beside.
TEST(Creeping, TrucksKeepTheirHeading) {
  constexpr int kSettles = 60;  // scans
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::bernoulli_distribution seen(0.8);
  const Eigen::Vector2d velocity(1.2, 0.0);
  const std::vector<double> found_rad = headings(160, [&](Scene& scene, int i) {
    const double rear_m = 14.0 + 0.05 * i * velocity.x();
    for (const double along : {0.0, 2.1, 5.2, 8.3, 11.4, 14.5}) {
      if (seen(random)) scene.add({rear_m + along + noise(random), -3.0 + noise(random)}, velocity);
    }
  });
  const auto settled = std::span(found_rad).subspan(kSettles);
  EXPECT_LT(rms(settled), 3.0 * kRadiansPerDegree);
  for (const double heading_rad : settled) EXPECT_NEAR(heading_rad, 0.0, 6.0 * kRadiansPerDegree);
}

}  // namespace
}  // namespace boresight::tracking
