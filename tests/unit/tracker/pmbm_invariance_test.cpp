// What must not change the estimates of the PMBM filter: the order of measurements, the axes; and how well its
// existence probabilities are calibrated.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "services/tracker/core/pmbm/pmbm_filter.hpp"
#include "tests/unit/tracker/list_model.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::pmbm {
namespace {

using support::Detections;
using support::ListModel;

constexpr double kInvariantStep_s = 0.1;

/// Two cars that cross, and clutter.
struct CrossingScene {
  CrossingScene(std::uint64_t seed, bool has_range_rates) : model(support::car_model(has_range_rates)), random(seed) {}
  void next() {
    const double log_clutter = support::car_log_clutter(model);
    model.list.clear();
    model.born.clear();
    for (Eigen::Vector4d& car : cars) {
      if (scan < 5) model.born.push_back(support::car_birth(car, 0.05));
      car.head<2>() += kInvariantStep_s * car.tail<2>();
      const Eigen::Matrix2d turn = support::rotation(std::atan2(car(3), car(2)));
      const Eigen::Matrix2d extent = turn * Eigen::Vector2d(4.0, 1.0).asDiagonal() * turn.transpose();
      const auto n = static_cast<std::size_t>(std::poisson_distribution<int>(7.0)(random));
      const Detections z = support::draw_detections(random, car, extent, model.sensor, n, log_clutter);
      model.list.insert(model.list.end(), z.begin(), z.end());
    }
    for (int i = 0; i < 12; ++i) {
      const double x = support::uniform(random, 0.0, 60.0), y = support::uniform(random, -25.0, 25.0);
      const double rate_mps = support::uniform(random, -20.0, 20.0);
      model.list.push_back(support::detection_at({x, y}, {0.0, 0.0}, rate_mps, log_clutter));
    }
    ++scan;
  }

  ListModel model;
  support::Random random;
  int scan = 0;
  std::array<Eigen::Vector4d, 2> cars{Eigen::Vector4d(12.0, 0.0, 10.0, 1.0), Eigen::Vector4d(30.0, -18.0, 0.0, 10.0)};
};

/// The estimates of one filter have their like in the other one's.
void expect_alike(const PmbmFilter& a, const PmbmFilter& b, double angle_rad, double tolerance, int scan) {
  ASSERT_EQ(a.estimates().size(), b.estimates().size()) << "scan " << scan;
  for (const ObjectEstimate& e : a.estimates()) {
    const support::Reference expected = support::rotated(support::reference_of(*e.component), angle_rad);
    const auto like = std::min_element(
        b.estimates().begin(), b.estimates().end(), [&](const ObjectEstimate& x, const ObjectEstimate& y) {
          return (support::eigen(x.component->position_m) - expected.mean.head<2>()).norm() <
                 (support::eigen(y.component->position_m) - expected.mean.head<2>()).norm();
        });
    EXPECT_NEAR(like->existence, e.existence, tolerance) << "scan " << scan;
    EXPECT_NEAR(like->detections, e.detections, tolerance * 10.0) << "scan " << scan;
    support::expect_equal(support::reference_of(*like->component), expected, tolerance);
  }
}

TEST(PmbmInvariance, TheOrderOfMeasurementsHardlyEverMatters) {
  // The search goes through the measurements in their order. Rarely, it ends in another one of two associations that
  // are nearly as likely.
  std::size_t all = 0, equal = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CrossingScene scene(seed, seed % 2 == 0);
    PmbmFilter ordered(Parameters{}, Capacity{}), shuffled(Parameters{}, Capacity{});
    support::Random other(99);
    for (int scan = 0; scan < 40; ++scan) {
      scene.next();
      ordered.step(scene.model, kInvariantStep_s);
      ListModel mixed_up = scene.model;
      std::shuffle(mixed_up.list.begin(), mixed_up.list.end(), other);
      shuffled.step(mixed_up, kInvariantStep_s);
      for (const ObjectEstimate& e : ordered.estimates()) {
        if (e.existence < 0.3) continue;
        ++all;
        const bool has_equal =
            std::any_of(shuffled.estimates().begin(), shuffled.estimates().end(), [&](const ObjectEstimate& o) {
              return std::abs(o.existence - e.existence) < 1e-6 &&
                     squared_norm(o.component->position_m - e.component->position_m) < 1e-12 &&
                     squared_norm(o.component->velocity_mps - e.component->velocity_mps) < 1e-10;
            });
        const bool has_like =
            std::any_of(shuffled.estimates().begin(), shuffled.estimates().end(), [&](const ObjectEstimate& o) {
              return std::abs(o.existence - e.existence) < 0.1 &&
                     squared_norm(o.component->position_m - e.component->position_m) < 1.0;
            });
        equal += has_equal ? 1 : 0;
        EXPECT_TRUE(has_like) << "seed " << seed << ", scan " << scan;
      }
    }
  }
  EXPECT_GT(all, 700U);
  EXPECT_GE(static_cast<double>(equal), 0.97 * static_cast<double>(all));
}

TEST(PmbmInvariance, ARotatedSceneGivesRotatedEstimates) {
  for (const bool has_range_rates : {false, true}) {
    for (const double angle : {0.4, 1.6, -2.5}) {
      CrossingScene scene(2, has_range_rates);
      PmbmFilter straight(Parameters{}, Capacity{}), turned(Parameters{}, Capacity{});
      for (int scan = 0; scan < 40; ++scan) {
        scene.next();
        straight.step(scene.model, kInvariantStep_s);
        ListModel rotated = scene.model;
        rotated.sensor = support::rotated(rotated.sensor, angle);
        rotated.list = support::rotated(rotated.list, angle);
        for (PoissonComponent& b : rotated.born) {
          b.component = support::component_of(support::rotated(support::reference_of(b.component), angle));
        }
        turned.step(rotated, kInvariantStep_s);
        expect_alike(straight, turned, angle, 1e-6, scan);
      }
    }
  }
}

TEST(PmbmExistence, IsCalibratedForObjectsOfFewDetectionsAmongClutter) {
  // One place of birth; objects with 1.5 detections a scan that end after 100 scans on average. Of all estimates with
  // an existence in an interval, as many are near a true object as the interval says.
  constexpr double kRate = 1.5, kArea_m2 = 60.0 * 40.0, kClutter = 8.0, kBirth = 0.02;
  constexpr std::size_t kBins = 5;
  std::array<double, kBins> estimates{}, sum{}, near{};
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    support::Random random(seed);
    ListModel model = support::car_model(false);
    model.motion.rate_memory_s = model.motion.extent_memory_s = 20.0;
    PoissonComponent birth = support::car_birth({30.0, 0.0, 0.0, 0.0}, kBirth);
    birth.component.rate_shape = 30.0;
    birth.component.rate_inverse_scale = birth.component.rate_shape / kRate;
    model.born = {birth};
    PmbmFilter filter(Parameters{}, Capacity{});
    std::vector<Eigen::Vector4d> objects;
    for (int scan = 0; scan < 300; ++scan) {
      std::erase_if(objects,
                    [&](const Eigen::Vector4d&) { return support::uniform(random, 0.0, 1.0) > model.survival; });
      model.list.clear();
      for (Eigen::Vector4d& o : objects) {
        const double ax = support::normal(random), ay = support::normal(random);
        o.tail<2>() += std::sqrt(model.motion.acceleration_density * kInvariantStep_s) * Eigen::Vector2d(ax, ay);
        o.head<2>() += kInvariantStep_s * o.tail<2>();
      }
      for (int i = std::poisson_distribution<int>(kBirth)(random); i > 0; --i) {
        Eigen::Vector4d o(30.0, 0.0, 0.0, 0.0);
        for (int k = 0; k < 4; ++k) o(k) += (k < 2 ? 3.0 : 2.0) * support::normal(random);
        objects.push_back(o);
      }
      const double log_clutter = std::log(kClutter / kArea_m2);
      for (const Eigen::Vector4d& o : objects) {
        if (support::uniform(random, 0.0, 1.0) > model.sensor.detection_probability) continue;
        const auto n = static_cast<std::size_t>(std::poisson_distribution<int>(kRate)(random));
        const Detections z =
            support::draw_detections(random, o, Eigen::Vector2d(4.0, 1.0).asDiagonal(), model.sensor, n, log_clutter);
        model.list.insert(model.list.end(), z.begin(), z.end());
      }
      for (int i = std::poisson_distribution<int>(kClutter)(random); i > 0; --i) {
        const double x = support::uniform(random, 0.0, 60.0), y = support::uniform(random, -20.0, 20.0);
        model.list.push_back(support::detection_at({x, y}, {0.0, 0.0}, 0.0, log_clutter));
      }
      filter.step(model, kInvariantStep_s);
      std::vector<char> taken(objects.size(), 0);
      for (const ObjectEstimate& e : filter.estimates()) {
        const auto bin = std::min(kBins - 1, static_cast<std::size_t>(e.existence * kBins));
        estimates[bin] += 1.0;
        sum[bin] += e.existence;
        for (std::size_t i = 0; i < objects.size(); ++i) {
          constexpr double kNear_m = 4.0;
          if (taken[i] != 0 || (support::eigen(e.component->position_m) - objects[i].head<2>()).norm() > kNear_m)
            continue;
          taken[i] = 1;
          near[bin] += 1.0;
          break;
        }
      }
    }
  }
  for (std::size_t b = 0; b < kBins; ++b) {
    ASSERT_GT(estimates[b], 100.0) << b;
    EXPECT_NEAR(near[b] / estimates[b], sum[b] / estimates[b], 0.12) << "interval " << b << " of " << estimates[b];
  }
}

}  // namespace
}  // namespace boresight::tracking::pmbm
