// Updates of a component against a Kalman filter with stacked measurements, and by hand.
#include <cmath>

#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/prediction.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

using support::Detections;
using support::Reference;

struct UpdateCase {
  Reference object;
  View<double> view;
  Detections z;
};
UpdateCase random_update_case(support::Random& random, bool has_range_rates, std::size_t n) {
  UpdateCase c{support::random_object(random), support::random_view(random, has_range_rates), {}};
  c.z = support::draw_detections(random, c.object.mean + Eigen::Vector4d(0.5, -0.3, 1.0, -0.7), c.object.extent(),
                                 c.view, n, -4.0);
  return c;
}
Reference updated_of(const UpdateCase& c) {
  const Component<double> prior = support::component_of(c.object);
  Prediction<double> p(prior, c.view);
  return support::reference_of(p.updated(prior, support::cell_of(c.z)));
}

TEST(ComponentUpdate, EqualsAKalmanFilterWithStackedPositions) {
  support::Random random(1);
  for (int run = 0; run < 300; ++run) {
    const UpdateCase c = random_update_case(random, false, 1 + static_cast<std::size_t>(run % 12));
    support::expect_equal(updated_of(c), support::updated_reference(c.object, c.view, c.z), 1e-9);
  }
}

TEST(ComponentUpdate, EqualsAKalmanFilterWithStackedPositionsAndRangeRates) {
  support::Random random(2);
  for (int run = 0; run < 300; ++run) {
    const UpdateCase c = random_update_case(random, true, 1 + static_cast<std::size_t>(run % 12));
    support::expect_equal(updated_of(c), support::updated_reference(c.object, c.view, c.z), 1e-9);
  }
}

TEST(ComponentUpdate, WithPlacesHeldFromScanToScanTrustsTheMeanLess) {
  support::Random random(3);
  for (int run = 0; run < 100; ++run) {
    UpdateCase c = random_update_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run % 6));
    const Reference fresh = updated_of(c);
    c.view.held = 3.0;
    const Reference held = updated_of(c);
    support::expect_equal(held, support::updated_reference(c.object, c.view, c.z), 1e-9);
    EXPECT_GT(held.covariance(0, 0), fresh.covariance(0, 0));
  }
}

TEST(ComponentUpdate, IsTheRotatedUpdateInRotatedAxes) {
  support::Random random(4);
  for (int run = 0; run < 100; ++run) {
    const UpdateCase c = random_update_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run % 6));
    const double angle = support::uniform(random, -3.0, 3.0);
    const UpdateCase turned{rotated(c.object, angle), support::rotated(c.view, angle), support::rotated(c.z, angle)};
    support::expect_equal(updated_of(turned), rotated(updated_of(c), angle), 1e-9);
  }
}

TEST(ComponentUpdate, IsTheDisplacedUpdateInDisplacedAxes) {
  support::Random random(5);
  for (int run = 0; run < 100; ++run) {
    UpdateCase c = random_update_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run % 6));
    Reference expected = updated_of(c);
    const Eigen::Vector2d shift(support::uniform(random, -500.0, 500.0), support::uniform(random, -500.0, 500.0));
    c.object.mean.head<2>() += shift;
    expected.mean.head<2>() += shift;
    for (auto& z : c.z) z.position_m = z.position_m + support::vector_of(shift);
    support::expect_equal(updated_of(c), expected, 1e-8);
  }
}

TEST(ComponentUpdate, WithoutRangeRatesIsTheLimitOfWorthlessRangeRates) {
  support::Random random(6);
  UpdateCase c = random_update_case(random, false, 5);
  const Reference without = updated_of(c);
  c.view.range_rate_variance = 1e12;
  support::expect_equal(updated_of(c), without, 1e-6);
}

TEST(ComponentUpdate, OfVelocityFromOneLineOfSightLeavesTheOtherDirectionAlone) {
  Component<double> prior;
  prior.position_m = {20.0, 0.0};
  prior.position_covariance = {1.0, 0.0, 1.0};
  prior.velocity_covariance = {25.0, 0.0, 25.0};
  prior.extent_scale = {4.0, 0.0, 4.0};
  View<double> view;
  view.detection_probability = 0.9;
  view.range_rate_variance = 0.04;
  Measurement<double> z;
  z.position_m = {20.0, 0.0};
  z.sight = {1.0, 0.0};
  z.range_rate_mps = 10.0;
  Prediction<double> p(prior, view);
  const Component<double> c = p.updated(prior, support::cell_of(std::span(&z, 1)));
  EXPECT_NEAR(c.velocity_mps.x, 10.0 * 25.0 / 25.04, 1e-12);
  EXPECT_EQ(c.velocity_mps.y, 0.0);
  EXPECT_NEAR(c.velocity_covariance.xx, 25.0 * 0.04 / 25.04, 1e-12);
  EXPECT_EQ(c.velocity_covariance.yy, 25.0);
  EXPECT_EQ(c.velocity_covariance.xy, 0.0);
}

TEST(ComponentUpdate, StaysPositiveDefiniteWithAHugePriorAndTinyNoise) {
  support::Random random(7);
  for (int run = 0; run < 200; ++run) {
    UpdateCase c = random_update_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run % 4));
    c.object.covariance *= 1e6;
    c.view.noise_m2 = {1e-8, 0.0, 1e-8};
    c.object.scale *= 1e-6;
    const Reference after = updated_of(c);
    const Eigen::LLT<Eigen::Matrix2d> place(Eigen::Matrix2d(after.covariance.topLeftCorner<2, 2>()));
    EXPECT_EQ(place.info(), Eigen::Success);
    EXPECT_EQ(after.covariance.llt().info(), Eigen::Success);
  }
}

TEST(ComponentUpdate, FollowsTheMirrorProbabilityOfItsDetections) {
  Component<double> prior;
  prior.extent_scale = {4.0, 0.0, 4.0};
  prior.rate_shape = 3.0;
  prior.mirror = 0.5;
  Detections z(2);
  z[0].mirror = 1.0;
  z[1].mirror = 0.8;
  Prediction<double> p(prior, View<double>{});
  EXPECT_NEAR(p.updated(prior, support::cell_of(z)).mirror, 0.5 + 0.4 * (0.9 - 0.5), 1e-12) << "weight 2 of 2 + 3";
}

TEST(ComponentUpdate, ForgetsTheOnlyRadarWhereAnotherOneSeesTheObject) {
  Component<double> prior;
  prior.extent_scale = {4.0, 0.0, 4.0};
  prior.source.radar = 1;
  const Detections z(1);
  View<double> view;
  EXPECT_EQ(Prediction<double>(prior, view).updated(prior, support::cell_of(z)).source.radar, 1);
  view.source_seen = 0.4;
  EXPECT_EQ(Prediction<double>(prior, view).updated(prior, support::cell_of(z)).source.radar, -1);
}

// One object by hand.

TEST(SingleObject, OneStepEqualsTheNumbersByHand) {
  Component<double> c;
  c.velocity_mps = {2.0, 0.0};
  c.position_covariance = {4.0, 0.0, 4.0};
  c.velocity_covariance = {1.0, 0.0, 1.0};
  c.rate_shape = 4.0;
  c.rate_inverse_scale = 2.0;
  c.extent_dof = 10.0;
  c.extent_scale = {16.0, 0.0, 4.0};  // X = diag(4, 1)
  MotionParameters motion;
  motion.acceleration_density = 3.0;
  motion.rate_memory_s = motion.extent_memory_s = 1.0 / std::log(2.0);  // halves in a second
  predict(c, motion, 1.0);
  EXPECT_NEAR(c.position_m.x, 2.0, 1e-12);
  EXPECT_NEAR(c.position_covariance.xx, 6.0, 1e-12) << "4 + 1 + 3/3";
  EXPECT_NEAR(c.position_velocity_covariance.xx, 2.5, 1e-12) << "1 + 3/2";
  EXPECT_NEAR(c.velocity_covariance.xx, 4.0, 1e-12) << "1 + 3";
  EXPECT_NEAR(c.rate_shape, 2.0, 1e-12);
  EXPECT_NEAR(c.rate_inverse_scale, 1.0, 1e-12);
  EXPECT_NEAR(c.extent_dof, 8.0, 1e-12);
  EXPECT_NEAR(c.extent_scale.xx, 8.0, 1e-12);

  // Two detections at (4, 1) and (2, 0): mean (3, 0.5), scatter [2 1; 1 0.5]; R = diag(1, 0.25), S = 6 + R/2.
  View<double> view;
  view.detection_probability = 0.9;
  view.exposure = 1.5;
  Detections z(2);
  z[0].position_m = {4.0, 1.0};
  z[1].position_m = {2.0, 0.0};
  Prediction<double> p(c, view);
  EXPECT_NEAR(p.missed(), 0.1 + 0.9 * (1.0 / 2.5) * (1.0 / 2.5), 1e-12);
  const Component<double> u = p.updated(c, support::cell_of(z));
  EXPECT_NEAR(u.position_m.x, 2.0 + 6.0 / 6.5, 1e-12);
  EXPECT_NEAR(u.position_m.y, 0.5 * 6.0 / 6.125, 1e-12);
  EXPECT_NEAR(u.velocity_mps.x, 2.0 + 2.5 / 6.5, 1e-12);
  EXPECT_NEAR(u.velocity_mps.y, 0.5 * 2.5 / 6.125, 1e-12);
  EXPECT_NEAR(u.position_covariance.xx, 6.0 * 0.5 / 6.5, 1e-12);
  EXPECT_NEAR(u.position_covariance.yy, 6.0 * 0.125 / 6.125, 1e-12);
  EXPECT_NEAR(u.position_velocity_covariance.xx, 2.5 * 0.5 / 6.5, 1e-12);
  EXPECT_NEAR(u.velocity_covariance.xx, 4.0 - 2.5 * 2.5 / 6.5, 1e-12);
  // X^½ R^−½ = 2 I; X^½ S^−½ e = (2 / √6.5, 0.5 / √6.125).
  EXPECT_NEAR(u.extent_scale.xx, 8.0 + 4.0 * 2.0 + 4.0 / 6.5, 1e-12);
  EXPECT_NEAR(u.extent_scale.xy, 4.0 * 1.0 + 1.0 / std::sqrt(6.5 * 6.125), 1e-12);
  EXPECT_NEAR(u.extent_scale.yy, 2.0 + 4.0 * 0.5 + 0.25 / 6.125, 1e-12);
  EXPECT_NEAR(u.extent_dof, 10.0, 1e-12);
  EXPECT_NEAR(u.rate_shape, 4.0, 1e-12);
  EXPECT_NEAR(u.rate_inverse_scale, 2.5, 1e-12);
}

TEST(SingleObject, WalksThroughManyScansAsTheDenseReference) {
  support::Random random(8);
  for (int run = 0; run < 20; ++run) {
    const UpdateCase start = random_update_case(random, run % 2 == 0, 1);
    MotionParameters motion;
    motion.acceleration_density = support::uniform(random, 0.5, 4.0);
    motion.rate_memory_s = support::uniform(random, 0.5, 5.0);
    motion.extent_memory_s = support::uniform(random, 0.5, 5.0);
    Eigen::Vector4d truth = start.object.mean;
    Reference expected = start.object;
    Component<double> c = support::component_of(start.object);
    for (int scan = 0; scan < 40; ++scan) {
      const double step_s = support::uniform(random, 0.03, 0.4);
      truth.head<2>() += step_s * truth.tail<2>();
      predict(c, motion, step_s);
      support::predict_reference(expected, motion, step_s);
      const auto n = static_cast<std::size_t>(scan % 5);
      if (n == 0) continue;
      const Detections z = support::draw_detections(random, truth, start.object.extent(), start.view, n, -4.0);
      Prediction<double> p(c, start.view);
      const Cell<double> cell = support::cell_of(z);
      EXPECT_NEAR(p.log_likelihood(cell), support::log_likelihood_reference(expected, start.view, z), 1e-6);
      c = p.updated(c, cell);
      expected = support::updated_reference(expected, start.view, z);
      support::expect_equal(support::reference_of(c), expected, 1e-8);
    }
  }
}

// Missed detections.

TEST(MissedDetection, GivesTheMomentsOfTheGammaMixture) {
  support::Random random(9);
  for (int run = 0; run < 40; ++run) {
    UpdateCase c = random_update_case(random, false, 1);
    c.object.rate_inverse_scale = c.object.rate_shape / support::uniform(random, 0.3, 4.0);
    const double alpha = c.object.rate_shape, beta = c.object.rate_inverse_scale, pd = c.view.detection_probability;
    // ∫ γ^k Gamma(γ; α, β) (1 − P_D + P_D exp(−γ e)) dγ by the midpoint rule.
    constexpr int kSteps = 40'000;
    const double from = std::log(alpha / beta) - 14.0, to = std::log(alpha / beta) + 4.0;
    double moments[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < kSteps; ++i) {
      const double log_rate = from + (to - from) * (i + 0.5) / kSteps, rate = std::exp(log_rate);
      const double density = std::exp(alpha * std::log(beta) - std::lgamma(alpha) + alpha * log_rate - beta * rate);
      const double p = density * (1.0 - pd + pd * std::exp(-rate * c.view.exposure)) * (to - from) / kSteps;
      moments[0] += p;
      moments[1] += p * rate;
      moments[2] += p * rate * rate;
    }
    const Component<double> prior = support::component_of(c.object);
    const Prediction<double> p(prior, c.view);
    const Component<double> missed = p.missed_component(prior);
    EXPECT_NEAR(p.missed(), moments[0], 1e-6);
    const double mean = moments[1] / moments[0], variance = moments[2] / moments[0] - mean * mean;
    // A share of "detected, but no point" below a thousandth is neglected.
    EXPECT_NEAR(missed.rate_shape / missed.rate_inverse_scale, mean, 2e-3 * mean);
    EXPECT_NEAR(missed.rate_shape / std::pow(missed.rate_inverse_scale, 2), variance, 5e-3 * variance);
    Reference rest = support::reference_of(missed);
    rest.rate_shape = alpha;
    rest.rate_inverse_scale = beta;
    support::expect_equal(rest, c.object, 1e-15);
  }
}

TEST(MissedDetection, OfASurelyUnseenObjectChangesNothing) {
  support::Random random(10);
  UpdateCase c = random_update_case(random, false, 1);
  c.view.detection_probability = 0.0;
  const Component<double> prior = support::component_of(c.object);
  const Prediction<double> p(prior, c.view);
  EXPECT_EQ(p.missed(), 1.0);
  support::expect_equal(support::reference_of(p.missed_component(prior)), c.object, 1e-15);
}

TEST(MissedDetection, OfASurelyDetectedObjectIsNeverImpossible) {
  // The chance of no point underflows; its logarithm must stay finite for the weights of hypotheses.
  Component<double> c;
  c.rate_shape = 5000.0;
  c.rate_inverse_scale = 1.0;
  c.extent_scale = {4.0, 0.0, 4.0};
  View<double> view;
  view.detection_probability = 1.0;
  EXPECT_TRUE(std::isfinite(std::log(Prediction<double>(c, view).missed())));
}

}  // namespace
}  // namespace boresight::tracking
