// The PMBM filter where the answer is known: single objects, births, crossings.
#include "services/tracker/core/pmbm/pmbm_filter.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "tests/unit/tracker/list_model.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::pmbm {
namespace {

using support::Detections;
using support::ListModel;
using support::Reference;

constexpr double kCarStep_s = 0.1;
/// One false detection in e^30 m²: none, but its logarithm is finite.
constexpr double kNoClutter = -30.0;

Eigen::Matrix2d car_extent() {
  return Eigen::Vector2d(4.0, 1.0).asDiagonal();
}

TEST(PmbmFilter, WithOneObjectAndNoClutterIsTheSingleObjectFilter) {
  for (const bool has_range_rates : {false, true}) {
    support::Random random(1);
    ListModel model = support::car_model(has_range_rates);
    Parameters parameters;
    parameters.gate_chi2 = 1e3;  // the single-object filter has none
    PmbmFilter filter(parameters, Capacity{});
    Eigen::Vector4d truth(20.0, -5.0, 8.0, 3.0);
    // So little that nothing of it is left after the first scan.
    const PoissonComponent birth = support::car_birth(truth + Eigen::Vector4d(1.0, -0.5, 1.0, 0.5), 1e-3);
    Reference expected = support::reference_of(birth.component);
    double existence = 0.0;
    for (int scan = 0; scan < 60; ++scan) {
      truth.head<2>() += kCarStep_s * truth.tail<2>();
      const std::size_t n = scan == 0 ? 5 : scan % 11 == 5 ? 0 : 1 + static_cast<std::size_t>(scan % 6);
      model.list = support::draw_detections(random, truth, car_extent(), model.sensor, n, kNoClutter);
      model.born.clear();
      if (scan == 0) model.born.push_back(birth);
      filter.step(model, kCarStep_s);
      if (scan > 0) {
        support::predict_reference(expected, model.motion, kCarStep_s);
        existence *= model.survival;
      }
      if (n > 0) {
        expected = support::updated_reference(expected, model.sensor, model.list);
        existence = 1.0;
      } else {
        const Component<double> prior = support::component_of(expected);
        const Prediction<double> p(prior, model.sensor);
        expected = support::reference_of(p.missed_component(prior));
        existence = existence * p.missed() / (1.0 - existence + existence * p.missed());
      }
      ASSERT_EQ(filter.estimates().size(), 1U);
      const ObjectEstimate& e = filter.estimates()[0];
      EXPECT_NEAR(e.source_existence, existence, 1e-9) << "scan " << scan;
      EXPECT_EQ(e.existence, e.source_existence);
      EXPECT_EQ(e.detected, n > 0);
      EXPECT_NEAR(e.detections, static_cast<double>(n), 1e-9);
      EXPECT_EQ(e.id, filter.estimates()[0].id);
      support::expect_equal(support::reference_of(*e.component), expected, 1e-9);
      EXPECT_LT((support::eigen(e.scatter) - support::sums_of(model.list).scatter).norm(), 1e-9);
    }
  }
}

TEST(PmbmFilter, ExistenceFallsByMissedDetectionsUntilTheObjectGoesBackToThePoissonPart) {
  ListModel model = support::car_model(false);
  support::Random random(2);
  PmbmFilter filter(Parameters{}, Capacity{});
  const Eigen::Vector4d truth(20.0, 0.0, 0.0, 0.0);
  model.born = {support::car_birth(truth, 0.001)};
  model.list = support::draw_detections(random, truth, car_extent(), model.sensor, 4, kNoClutter);
  filter.step(model, kCarStep_s);
  model.list.clear();
  model.born.clear();
  double r = 1.0;
  for (int scan = 0; scan < 8; ++scan) {
    ASSERT_EQ(filter.estimates().size(), 1U);
    Component<double> c = *filter.estimates()[0].component;
    filter.step(model, kCarStep_s);
    r *= model.predict(c, kCarStep_s);
    const double q = Prediction<double>(c, model.sensor).missed();
    r = r * q / (1.0 - r + r * q);
    if (r < Parameters{}.min_existence) {
      EXPECT_TRUE(filter.estimates().empty());
      // The object is still known in the Poisson part: seen again, it is there at once.
      model.list = support::draw_detections(random, truth, car_extent(), model.sensor, 4, kNoClutter);
      filter.step(model, kCarStep_s);
      ASSERT_EQ(filter.estimates().size(), 1U);
      EXPECT_GT(filter.estimates()[0].existence, 0.99);
      return;
    }
    EXPECT_NEAR(filter.estimates()[0].existence, r, 1e-12);
  }
  FAIL() << "never below the least existence";
}

TEST(PmbmFilter, ObjectsFarApartAreAsInFiltersOfTheirOwn) {
  support::Random random(3);
  ListModel model = support::car_model(true);
  const double log_clutter = support::car_log_clutter(model);
  PmbmFilter both(Parameters{}, Capacity{}), first(Parameters{}, Capacity{}), second(Parameters{}, Capacity{});
  Eigen::Vector4d a(20.0, -10.0, 5.0, 0.0), b(150.0, 40.0, -5.0, 1.0);
  for (int scan = 0; scan < 60; ++scan) {
    a.head<2>() += kCarStep_s * a.tail<2>();
    b.head<2>() += kCarStep_s * b.tail<2>();
    const auto near = [&](const Eigen::Vector4d& truth) {
      const std::size_t n = support::uniform(random, 0.0, 1.0) < 0.9 ? 1 + random() % 8 : 0;
      Detections z = support::draw_detections(random, truth, car_extent(), model.sensor, n, log_clutter);
      if (scan % 3 == 0) {  // and false ones about it
        z.push_back(support::detection_at(
            truth.head<2>() + Eigen::Vector2d(support::uniform(random, -8.0, 8.0), support::uniform(random, -8.0, 8.0)),
            truth.tail<2>(), support::uniform(random, -5.0, 5.0), log_clutter));
      }
      return z;
    };
    const Detections of_a = near(a), of_b = near(b);
    const PoissonComponent birth_a = support::car_birth(a, 0.02), birth_b = support::car_birth(b, 0.02);
    model.list = of_a;
    model.born = {birth_a};
    first.step(model, kCarStep_s);
    model.list = of_b;
    model.born = {birth_b};
    second.step(model, kCarStep_s);
    model.list = of_b;
    model.list.insert(model.list.end(), of_a.begin(), of_a.end());
    model.born = {birth_a, birth_b};
    both.step(model, kCarStep_s);

    std::vector<ObjectEstimate> expected(first.estimates().begin(), first.estimates().end());
    expected.insert(expected.end(), second.estimates().begin(), second.estimates().end());
    ASSERT_EQ(both.estimates().size(), expected.size()) << "scan " << scan;
    for (const ObjectEstimate& e : expected) {
      const auto same = std::find_if(both.estimates().begin(), both.estimates().end(), [&](const ObjectEstimate& o) {
        return squared_norm(o.component->position_m - e.component->position_m) < 1e-12;
      });
      ASSERT_NE(same, both.estimates().end()) << "scan " << scan;
      EXPECT_NEAR(same->existence, e.existence, 1e-9);
      support::expect_equal(support::reference_of(*same->component), support::reference_of(*e.component), 1e-7);
    }
  }
}

TEST(PmbmFilter, CrossingObjectsKeepTheirIdentity) {
  // Both are at one place for a scan, with the detections of either.
  constexpr int kRunsWithoutIdentity = 1;
  int lost = 0;
  for (const bool has_range_rates : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      support::Random random(seed);
      ListModel model = support::car_model(has_range_rates);
      const double log_clutter = support::car_log_clutter(model);
      PmbmFilter filter(Parameters{}, Capacity{});
      // At right angles; both are at (30, 0) after 2 s.
      Eigen::Vector4d a(10.0, 0.0, 10.0, 0.0), b(30.0, -20.0, 0.0, 10.0);
      std::uint32_t id_a = 0, id_b = 0;
      for (int scan = 0; scan < 40; ++scan) {
        a.head<2>() += kCarStep_s * a.tail<2>();
        b.head<2>() += kCarStep_s * b.tail<2>();
        model.list.clear();
        for (const Eigen::Vector4d& truth : {a, b}) {
          if (support::uniform(random, 0.0, 1.0) > 0.95) continue;
          const auto n = static_cast<std::size_t>(std::poisson_distribution<int>(8.0)(random));
          const Eigen::Matrix2d turn = support::rotation(std::atan2(truth(3), truth(2)));
          const Detections z = support::draw_detections(random, truth, turn * car_extent() * turn.transpose(),
                                                        model.sensor, n, log_clutter);
          model.list.insert(model.list.end(), z.begin(), z.end());
        }
        model.born.clear();
        if (scan < 5) model.born = {support::car_birth(a, 0.05), support::car_birth(b, 0.05)};
        filter.step(model, kCarStep_s);
        if (scan != 9 && scan != 39) continue;
        ASSERT_EQ(std::count_if(filter.estimates().begin(), filter.estimates().end(),
                                [](const ObjectEstimate& e) { return e.existence > 0.5; }),
                  2)
            << "seed " << seed << ", scan " << scan;
        const auto nearest = [&](const Eigen::Vector4d& truth) {
          return std::min_element(filter.estimates().begin(), filter.estimates().end(),
                                  [&](const ObjectEstimate& x, const ObjectEstimate& y) {
                                    const auto at = support::vector_of(truth.head<2>());
                                    return squared_norm(x.component->position_m - at) <
                                           squared_norm(y.component->position_m - at);
                                  })
              ->id;
        };
        if (scan == 9) {
          id_a = nearest(a);
          id_b = nearest(b);
          ASSERT_NE(id_a, id_b);
        } else {
          lost += nearest(a) != id_a || nearest(b) != id_b ? 1 : 0;
        }
      }
    }
  }
  EXPECT_LE(lost, kRunsWithoutIdentity);
}

/// Σ w P_D p(z) over clutter, from the reference.
double expected_births(const ListModel& model, std::span<const Measurement<double>> z) {
  double sum = 0.0;
  for (const PoissonComponent& b : model.born) {
    sum += b.weight * std::exp(support::log_likelihood_reference(support::reference_of(b.component), model.sensor, z));
  }
  return sum;
}

TEST(PmbmBirth, OfOneIsolatedMeasurementHasTheExistenceOfTheClosedForm) {
  for (const bool has_range_rates : {false, true}) {
    for (const double log_clutter : {-12.0, -9.0, -7.0}) {
      ListModel model = support::car_model(has_range_rates);
      const Eigen::Vector4d at(25.0, 4.0, 6.0, -2.0);
      // Births nearer to each other than this are merged.
      model.born = {support::car_birth(at, 0.2), support::car_birth(at + Eigen::Vector4d(5.0, 3.0, -1.0, 0.0), 0.1)};
      model.list = {support::detection_at({26.8, 4.9}, {6.5, -2.0}, 0.0, log_clutter)};
      const double e = expected_births(model, model.list);
      PmbmFilter filter(Parameters{}, Capacity{});
      filter.step(model, kCarStep_s);
      if (e / (1.0 + e) < Parameters{}.min_existence) {
        EXPECT_TRUE(filter.estimates().empty());
        continue;
      }
      ASSERT_EQ(filter.estimates().size(), 1U);
      EXPECT_NEAR(filter.estimates()[0].existence, e / (1.0 + e), 1e-9);
    }
  }
}

TEST(PmbmBirth, OfObjectsAnywhereHasTheExistenceOfTheClosedForm) {
  ListModel model = support::car_model(true);
  model.newborn_prior = support::car_birth(Eigen::Vector4d::Zero(), 1.0).component;
  model.newborn_prior.position_covariance = {900.0, 0.0, 900.0};
  model.anywhere_per_m2 = 1e-4;
  model.list = {support::detection_at({25.8, 4.9}, {1.0, 0.5}, 0.0, -14.0)};
  const double e = std::exp(model.log_newborn(support::cell_of(model.list)));
  PmbmFilter filter(Parameters{}, Capacity{});
  filter.step(model, kCarStep_s);
  ASSERT_EQ(filter.estimates().size(), 1U);
  EXPECT_NEAR(filter.estimates()[0].existence, e / (1.0 + e), 1e-9);
  EXPECT_NEAR(filter.estimates()[0].component->position_m.x, 25.8, 1e-9);
}

TEST(PmbmBirth, StateIsTheMixtureOfAllBirthComponents) {
  ListModel model = support::car_model(false);
  support::Random random(5);
  const Eigen::Vector4d at(25.0, 4.0, 6.0, -2.0);
  model.born = {support::car_birth(at, 0.2), support::car_birth(at + Eigen::Vector4d(5.0, 3.0, -1.0, 0.0), 0.3)};
  model.list = support::draw_detections(random, at + Eigen::Vector4d(2.5, 1.5, 0.0, 0.0), car_extent(), model.sensor, 6,
                                        kNoClutter);
  std::vector<Component<double>> updated;
  std::vector<WeightedComponent<double>> mixture;
  for (const PoissonComponent& b : model.born) {
    const Reference r = support::reference_of(b.component);
    updated.push_back(support::component_of(support::updated_reference(r, model.sensor, model.list)));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Reference r = support::reference_of(model.born[i].component);
    const double log_p = support::log_likelihood_reference(r, model.sensor, model.list) - 6.0 * -kNoClutter;
    mixture.push_back({model.born[i].weight * std::exp(log_p), &updated[i]});
  }
  PmbmFilter filter(Parameters{}, Capacity{});
  filter.step(model, kCarStep_s);
  ASSERT_EQ(filter.estimates().size(), 1U);
  EXPECT_NEAR(filter.estimates()[0].existence, 1.0, 1e-9);
  support::expect_equal(support::reference_of(*filter.estimates()[0].component),
                        support::reference_of(merge<double>(mixture)), 1e-8);
}

TEST(PmbmBirth, WithoutDetectionsWaitsInThePoissonPart) {
  ListModel model = support::car_model(false);
  const Eigen::Vector4d at(25.0, 4.0, 0.0, 0.0);
  PmbmFilter filter(Parameters{}, Capacity{});
  // The weight of undetected objects grows by each birth and falls by each scan without detections.
  double weight = 0.0;
  model.born = {support::car_birth(at, 0.05)};
  for (int scan = 0; scan < 5; ++scan) {
    filter.step(model, kCarStep_s);
    EXPECT_TRUE(filter.estimates().empty());
    weight = weight * model.survival + 0.05;
    weight *= Prediction<double>(model.born[0].component, model.sensor).missed();
  }
  // The chance of a single measurement shows it; the components differ by little from the birth.
  model.list = {support::detection_at({25.0, 4.0}, {0.0, 0.0}, 0.0, -12.0)};
  const double all = weight * model.survival + 0.05;
  model.born[0].weight = all;
  const double e = expected_births(model, model.list);
  model.born[0].weight = 0.05;
  filter.step(model, kCarStep_s);
  ASSERT_EQ(filter.estimates().size(), 1U);
  EXPECT_NEAR(filter.estimates()[0].existence, e / (1.0 + e), 0.01);
}

TEST(PmbmBirth, OfWeightZeroIsNone) {
  ListModel model = support::car_model(false);
  support::Random random(11);
  const Eigen::Vector4d none(25.0, 4.0, 0.0, 0.0), some(34.0, 4.0, 0.0, 0.0);
  model.list = support::draw_detections(random, some, car_extent(), model.sensor, 6, -9.0);
  model.born = {support::car_birth(none, 0.0)};
  PmbmFilter empty(Parameters{}, Capacity{});
  empty.step(model, kCarStep_s);
  EXPECT_TRUE(empty.estimates().empty());
  model.born = {support::car_birth(none, 0.0), support::car_birth(some, 0.05)};
  PmbmFilter filter(Parameters{}, Capacity{});
  filter.step(model, kCarStep_s);
  ASSERT_EQ(filter.estimates().size(), 1U);
  EXPECT_GT(filter.estimates()[0].existence, 0.9);
  EXPECT_TRUE(std::isfinite(filter.estimates()[0].component->position_m.x));
}

/// A model with births at any place.
ListModel anywhere_model(bool has_range_rates) {
  ListModel model = support::car_model(has_range_rates);
  model.newborn_prior = support::car_birth(Eigen::Vector4d::Zero(), 1.0).component;
  model.newborn_prior.position_covariance = {900.0, 0.0, 900.0};
  model.anywhere_per_m2 = 1e-4;
  return model;
}

TEST(PmbmBirth, IsNotHiddenByOneFalseDetectionInTheObject) {
  // It lies in the middle of the object, but its range rate is of another velocity.
  int born = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    support::Random random(seed);
    ListModel model = anywhere_model(true);
    const double log_clutter = support::car_log_clutter(model);
    const Eigen::Vector4d truth(30.0, 5.0, 1.0, 0.0);
    model.list = support::draw_detections(random, truth, car_extent(), model.sensor, 6, log_clutter);
    model.list.push_back(support::detection_at({30.0, 5.0}, truth.tail<2>(), 6.0, log_clutter));
    PmbmFilter filter(Parameters{}, Capacity{});
    filter.step(model, kCarStep_s);
    born += !filter.estimates().empty() && filter.estimates()[0].existence > 0.9 ? 1 : 0;
  }
  EXPECT_GE(born, 18);
}

/// Mean number of objects born in the first scan of ten cars in a queue, whose detections are all linked.
double born_of_queue(double distance_m) {
  constexpr int kRuns = 20, kCars = 10;
  double born = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    support::Random random(seed);
    ListModel model = anywhere_model(false);
    model.list.clear();
    for (int i = 0; i < kCars; ++i) {
      const Detections z =
          support::draw_detections(random, {30.0 + distance_m * i, 0.0, 0.0, 0.0}, car_extent(), model.sensor, 8, -9.0);
      model.list.insert(model.list.end(), z.begin(), z.end());
    }
    PmbmFilter filter(Parameters{}, Capacity{});
    filter.step(model, kCarStep_s);
    born += static_cast<double>(std::count_if(filter.estimates().begin(), filter.estimates().end(),
                                              [](const ObjectEstimate& e) { return e.existence > 0.5; })) /
            kRuns;
  }
  return born;
}

TEST(PmbmBirth, OfManyObjectsInAQueueIsOfMostInTheFirstScan) {
  EXPECT_NEAR(born_of_queue(7.0), 10.0, 0.5);
  // 2 m from bumper to bumper, and the detections of a car scatter by 1 m.
  EXPECT_GT(born_of_queue(6.0), 7.5);
}

TEST(PmbmFilter, WeightsOfAllHypothesesAddUpToOne) {
  // Objects that exist for sure and never end: their existence is the sum of the weights of all hypotheses.
  support::Random random(7);
  for (int run = 0; run < 20; ++run) {
    ListModel model = support::car_model(false);
    model.survival = 1.0;
    const double log_clutter = support::car_log_clutter(model);
    PmbmFilter filter(Parameters{}, Capacity{});
    std::vector<Eigen::Vector4d> truth;
    for (int i = 0; i < 3; ++i) truth.emplace_back(20.0 + 9.0 * i, 0.0, 0.0, 0.0);
    for (int scan = 0; scan < 20; ++scan) {
      model.list.clear();
      model.born.clear();
      for (auto& t : truth) {
        if (scan == 0) model.born.push_back(support::car_birth(t, 0.001));
        const double speed = scan < 6 ? 0.0 : scan < 12 ? -1.0 : 1.0;  // together and apart again
        t.x() += kCarStep_s * speed * (t.x() - 29.0);
        const std::size_t n = scan == 0 ? 6 : random() % 7;
        const Detections z =
            support::draw_detections(random, t, car_extent(), model.sensor, n, scan == 0 ? kNoClutter : log_clutter);
        model.list.insert(model.list.end(), z.begin(), z.end());
      }
      filter.step(model, kCarStep_s);
      ASSERT_GE(filter.estimates().size(), 3U) << "run " << run << ", scan " << scan;
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(filter.estimates()[i].source_existence, 1.0, 1e-9) << scan;
      for (const double x : filter.explained()) {
        EXPECT_GE(x, 0.0);
        EXPECT_LE(x, 1.0 + 1e-9);
      }
    }
  }
}

TEST(PmbmFilter, ExplainsDetectionsOfTrackedObjectsAndNoClutter) {
  support::Random random(8);
  ListModel model = support::car_model(true);
  const double log_clutter = support::car_log_clutter(model);
  PmbmFilter filter(Parameters{}, Capacity{});
  const Eigen::Vector4d truth(30.0, 5.0, 0.0, 0.0);
  for (int scan = 0; scan < 10; ++scan) {
    model.born = {support::car_birth(truth, 0.02)};
    model.list = support::draw_detections(random, truth, car_extent(), model.sensor, 5, log_clutter);
    model.list.push_back(support::detection_at({80.0, -20.0}, {0.0, 0.0}, 3.0, log_clutter));
    model.list.push_back(support::detection_at({30.0, 5.0}, {0.0, 0.0}, 9.0, log_clutter));  // wrong range rate
    filter.step(model, kCarStep_s);
    ASSERT_EQ(filter.explained().size(), model.list.size());
    if (scan == 0) {
      for (const double x : filter.explained()) EXPECT_EQ(x, 0.0) << "nothing was tracked yet";
      continue;
    }
    for (std::size_t i = 0; i < 5; ++i) EXPECT_GT(filter.explained()[i], 0.5);
    EXPECT_EQ(filter.explained()[5], 0.0);
    EXPECT_LT(filter.explained()[6], 0.05);
  }
}

TEST(PmbmFilter, ForgetsEverythingWhenCleared) {
  support::Random random(9);
  ListModel model = support::car_model(false);
  const Eigen::Vector4d truth(30.0, 5.0, 0.0, 0.0);
  PmbmFilter filter(Parameters{}, Capacity{});
  model.born = {support::car_birth(truth, 0.5)};
  model.list = support::draw_detections(random, truth, car_extent(), model.sensor, 5, kNoClutter);
  filter.step(model, kCarStep_s);
  ASSERT_EQ(filter.estimates().size(), 1U);
  const std::uint32_t id = filter.estimates()[0].id;
  filter.clear();
  EXPECT_TRUE(filter.estimates().empty());
  model.born.clear();
  filter.step(model, kCarStep_s);
  EXPECT_TRUE(filter.estimates().empty()) << "no object, and no births left";
  model.born = {support::car_birth(truth, 0.5)};
  filter.step(model, kCarStep_s);
  ASSERT_EQ(filter.estimates().size(), 1U);
  EXPECT_NE(filter.estimates()[0].id, id) << "identities are never used again";
}

TEST(PmbmFilter, PartsOfOneObjectBecomeOne) {
  support::Random random(10);
  ListModel model = support::car_model(false);
  const double log_clutter = support::car_log_clutter(model);
  const Eigen::Vector4d a(30.0, 0.0, 0.0, 0.0), b(40.0, 0.0, 0.0, 0.0);
  PmbmFilter filter(Parameters{}, Capacity{});
  const auto step = [&](bool has_births) {
    model.born.clear();
    if (has_births) model.born = {support::car_birth(a, 0.05), support::car_birth(b, 0.05)};
    model.list = support::draw_detections(random, a, car_extent(), model.sensor, 6, log_clutter);
    const Detections z = support::draw_detections(random, b, car_extent(), model.sensor, 6, log_clutter);
    model.list.insert(model.list.end(), z.begin(), z.end());
    filter.step(model, kCarStep_s);
  };
  for (int scan = 0; scan < 5; ++scan) step(true);
  ASSERT_EQ(filter.estimates().size(), 2U);
  const std::uint32_t older = std::min(filter.estimates()[0].id, filter.estimates()[1].id);
  model.one_within_m = 12.0;
  step(false);
  ASSERT_EQ(filter.estimates().size(), 1U);
  EXPECT_EQ(filter.estimates()[0].id, older);
  const double at_m = filter.estimates()[0].component->position_m.x;
  EXPECT_LT(std::min(std::abs(at_m - 30.0), std::abs(at_m - 40.0)), 1.0) << "the tracked point of the whole";
  EXPECT_GT(filter.estimates()[0].existence, 0.9);
  for (int scan = 0; scan < 5; ++scan) {
    step(false);
    for (const ObjectEstimate& e : filter.estimates()) {
      EXPECT_TRUE(std::isfinite(e.existence));
      EXPECT_TRUE(std::isfinite(e.component->position_m.x));
    }
    ASSERT_FALSE(filter.estimates().empty());
    EXPECT_EQ(filter.estimates()[0].id, older);
  }
}

}  // namespace
}  // namespace boresight::tracking::pmbm
