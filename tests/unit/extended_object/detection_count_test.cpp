#include "services/common/extended_object/detection_count.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::extended_object {
namespace {

using Eigen::Vector2d;

const Vector2d kBehind(-1.0, 0.0), kAhead(1.0, 0.0), kLeft(0.0, 1.0), kRight(0.0, -1.0);

TEST(DetectionCount, FallsWithRangeAndDependsOnAspect) {
  for (const ObjectClassModel& m : object_class_table_defaults()) {
    double before = 1e9;
    for (double range = 0.0; range < 150.0; range += 1.0) {
      const double n = expected_detections(m.count, range, kBehind);
      EXPECT_TRUE(std::isfinite(n));
      EXPECT_LT(n, before);
      before = n;
    }
    EXPECT_DOUBLE_EQ(expected_detections(m.count, 20.0, kLeft), expected_detections(m.count, 20.0, kRight));
    EXPECT_NEAR(expected_detections(m.count, 20.0, kAhead) / expected_detections(m.count, 20.0, kBehind),
                m.count.front_factor / m.count.rear_factor, 1e-12);
    EXPECT_NEAR(expected_detections(m.count, 20.0, kLeft) / expected_detections(m.count, 20.0, kBehind),
                m.count.side_factor / m.count.rear_factor, 1e-12);
  }
}

TEST(DetectionCount, NoneIsAsLikelyAsInTheGammaPoissonMixture) {
  const DetectionCount count{.dispersion_shape = 2.5};
  const double mean = 1.7, shape = count.dispersion_shape;
  double none = 0.0;  // ∫ Gamma(λ; k, mean) exp(−λ) dλ
  for (double rate = 0.0005; rate < 40.0; rate += 0.001) {
    none += 0.001 * std::exp((shape - 1.0) * std::log(rate) - rate * shape / mean + shape * std::log(shape / mean) -
                             std::lgamma(shape) - rate);
  }
  EXPECT_NEAR(no_detection_probability(count, mean), none, 1e-5);
  EXPECT_DOUBLE_EQ(no_detection_probability(count, 0.0), 1.0);
}

TEST(DetectionCount, WithoutDispersionIsPoisson) {
  EXPECT_DOUBLE_EQ(no_detection_probability(DetectionCount{}, 1.3), std::exp(-1.3));
}

TEST(DetectionCount, StaysFiniteWithoutANearRange) {
  EXPECT_TRUE(std::isfinite(expected_detections({.mean_at_30m = 1.0, .range_power = 2.0}, 0.0, kAhead)));
}

}  // namespace
}  // namespace boresight::extended_object
