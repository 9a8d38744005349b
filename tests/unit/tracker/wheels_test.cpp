// Wheels turn with other range rates than their vehicle's, which must not change its speed.
#include "services/tracker/core/wheels.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

/// By how much a last detection, whose range rate is that much more than the body's, makes a car faster.
double faster_by(double more_mps) {
  return changed_by_last_scan(
      [more_mps](Scene& scene, int i, bool is_last) {
        scene.add({20.0 + 0.5 * i, 3.0}, {10.0, 0.0});
        if (is_last) scene.scan->range_rate_over_ground_mps[0] += static_cast<float>(more_mps);
      },
      [](const Track& track) { return track.velocity_over_ground_mps[0]; });
}

}  // namespace

TEST(Wheels, OneWheelMakesNothingFaster) {
  const double of_noise = faster_by(0.5) - faster_by(0.0), of_wheel = faster_by(1.5) - faster_by(0.0);
  EXPECT_GT(of_noise, 0.0);
  EXPECT_LT(of_wheel, of_noise);
}

TEST(Wheels, AreTheLikelierTheFartherTheRangeRateIsOff) {
  KinematicState state;
  state.mean.setZero();
  state.mean(2) = 10.0;
  state.covariance.setIdentity();
  PositionRate measurement;
  measurement.line_of_sight = {1.0, 0.0};
  measurement.covariance.setIdentity();
  double before = 1.0;
  for (double off_mps = 0.0; off_mps < 30.0; off_mps += 1.0) {
    measurement.value << 0.0, 0.0, 10.0 + off_mps;
    const double body = chance_of_body(state, measurement);
    EXPECT_LE(body, before);
    EXPECT_GT(body, 0.0);
    before = body;
  }
  EXPECT_LT(before, 0.01);
  measurement.value << 0.0, 0.0, 10.0;
  EXPECT_GT(chance_of_body(state, measurement), 0.7);
}

}  // namespace boresight::tracking
