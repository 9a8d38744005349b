// The PHD filter: partitions of hand-made sets, and the filter against the single-object filter and counts by hand.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/tracker/core/phd/partitions.hpp"
#include "services/tracker/core/phd/phd_filter.hpp"
#include "tests/unit/tracker/list_model.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::phd {
namespace {

using support::car_birth;
using support::car_log_clutter;
using support::car_model;
using support::Detections;
using support::ListModel;

// --- Partitions -----------------------------------------------------------------------------------------------------

Detections at(std::initializer_list<Eigen::Vector2d> places_m) {
  Detections z;
  for (const Eigen::Vector2d& p : places_m) z.push_back(support::detection_at(p, {0.0, 0.0}, 0.0, 0.0));
  return z;
}

using Cells = std::set<std::set<std::size_t>>;

class PhdPartitions : public ::testing::Test {
 protected:
  void begin(const Detections& z) {
    z_ = z;
    keys_.clear();
    for (std::size_t i = 0; i < z_.size(); ++i) keys_.push_back(mixed(i + 1));
    partitions_.begin(z_, keys_);
  }
  [[nodiscard]] Cells cells(std::size_t partition) const {
    std::vector<std::set<std::size_t>> by_cell(partitions_.cells().size());
    for (std::size_t i = 0; i < z_.size(); ++i) {
      by_cell[static_cast<std::size_t>(partitions_.labels(partition)[i])].insert(i);
    }
    Cells out;
    for (const std::int16_t c : partitions_.cells_of(partition)) out.insert(by_cell[static_cast<std::size_t>(c)]);
    return out;
  }
  [[nodiscard]] std::set<Cells> all() const {
    std::set<Cells> out;
    for (std::size_t p = 0; p < partitions_.size(); ++p) out.insert(cells(p));
    return out;
  }

  ListModel model_ = car_model(false);
  Detections z_;
  std::vector<std::uint64_t> keys_;
  Partitions partitions_{Parameters{}, Capacity{}};
};

TEST_F(PhdPartitions, ByDistanceIsEachSingleLinkageOnceFromTheCoarsest) {
  begin(at({{0.0, 0.0}, {1.0, 0.0}, {1.5, 0.0}, {4.0, 0.0}, {30.0, 0.0}}));
  partitions_.add_by_distance(model_);  // links up to 5 m
  ASSERT_EQ(partitions_.size(), 4u);
  EXPECT_EQ(cells(0), (Cells{{0, 1, 2, 3}, {4}}));
  EXPECT_EQ(cells(1), (Cells{{0, 1, 2}, {3}, {4}}));
  EXPECT_EQ(cells(2), (Cells{{0}, {1, 2}, {3}, {4}}));
  EXPECT_EQ(cells(3), (Cells{{0}, {1}, {2}, {3}, {4}}));
  EXPECT_EQ(partitions_.cells().size(), 8u);  // each different cell once
}

TEST_F(PhdPartitions, EqualDistancesAreOneThreshold) {
  begin(at({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {3.0, 0.0}}));
  partitions_.add_by_distance(model_);
  EXPECT_EQ(partitions_.size(), 2u);
}

TEST_F(PhdPartitions, CellsHoldTheSumsOfTheirMeasurements) {
  begin(at({{0.0, 1.0}, {2.0, 3.0}, {30.0, 0.0}}));
  partitions_.add_by_distance(model_);
  for (std::size_t p = 0; p < partitions_.size(); ++p) {
    for (const std::int16_t c : partitions_.cells_of(p)) {
      Cell<double> expected;
      for (std::size_t i = 0; i < z_.size(); ++i) {
        if (partitions_.labels(p)[i] == c) expected.add(z_[i], keys_[i]);
      }
      const Cell<double>& cell = partitions_.cells()[static_cast<std::size_t>(c)];
      EXPECT_EQ(cell.n, expected.n);
      EXPECT_EQ(cell.key, expected.key);
      EXPECT_NEAR(cell.sum_squares.xy, expected.sum_squares.xy, 1e-12);
    }
  }
}

TEST_F(PhdPartitions, PredictionJoinsByObjectAndTheRestByLinks) {
  // Objects 7 and 9; measurements 3 and 4 are near each other and of no object.
  begin(at({{0.0, 0.0}, {8.0, 0.0}, {1.0, 0.0}, {20.0, 0.0}, {21.0, 0.0}}));
  const std::vector<std::int16_t> objects = {7, 7, 9, Partitions::kNone, Partitions::kNone};
  partitions_.add_predicted(model_, objects, Rest::kAlone);
  partitions_.add_predicted(model_, objects, Rest::kLinked);
  ASSERT_EQ(partitions_.size(), 2u);
  EXPECT_EQ(cells(0), (Cells{{0, 1}, {2}, {3}, {4}}));
  EXPECT_EQ(cells(1), (Cells{{0, 1}, {2}, {3, 4}}));
}

TEST_F(PhdPartitions, KnownPartitionIsNotAddedAgain) {
  begin(at({{0.0, 0.0}, {1.0, 0.0}}));
  partitions_.add_by_distance(model_);
  ASSERT_EQ(partitions_.size(), 2u);
  const std::vector<std::int16_t> one = {3, 3}, other_labels = {1, 0};
  partitions_.add_predicted(model_, one, Rest::kAlone);
  partitions_.add(other_labels);
  EXPECT_EQ(partitions_.size(), 2u);
}

TEST_F(PhdPartitions, CellWithDetectionsOfTwoObjectsIsSplitBetweenThem) {
  begin(at({{0.0, 0.0}, {3.0, 0.1}, {0.2, 0.3}, {3.2, -0.2}, {-0.1, 0.2}, {2.9, 0.0}, {1.6, 0.0}}));
  const std::vector<std::int16_t> one(7, 0);
  partitions_.add(one);
  partitions_.add_split([](const Cell<double>&) { return 5.0; });  // 7 ln 2 < 5
  EXPECT_EQ(partitions_.size(), 1u);
  partitions_.add_split([](const Cell<double>& cell) { return cell.n > 4.0 ? 3.5 : 100.0; });
  ASSERT_EQ(partitions_.size(), 2u);
  EXPECT_EQ(cells(1), (Cells{{0, 2, 4}, {1, 3, 5, 6}}));
}

TEST_F(PhdPartitions, EqualMeasurementsAreNotSplit) {
  begin(at({{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}));
  const std::vector<std::int16_t> one(3, 0);
  partitions_.add(one);
  partitions_.add_split([](const Cell<double>&) { return 0.1; });
  EXPECT_EQ(partitions_.size(), 1u);
}

TEST_F(PhdPartitions, SharedPartitionDividesMeasurementsAndCountsItsAssignments) {
  begin(at({{0.0, 0.0}, {1.0, 0.0}, {20.0, 0.0}}));
  const std::vector<std::int16_t> objects = {0, 1, Partitions::kNone};
  const std::vector<double> shares = {0.75, 0.25, 0.25, 0.5, 0.0, 0.0};  // of the second, 0.25 is clutter
  partitions_.add_shared(model_, objects, shares, 2, Rest::kAlone);
  ASSERT_EQ(partitions_.size(), 1u);
  const auto list = partitions_.cells_of(0);
  ASSERT_EQ(list.size(), 3u);
  const auto cell = [&](std::size_t k) { return partitions_.cells()[static_cast<std::size_t>(list[k])]; };
  EXPECT_NEAR(cell(0).n, 1.0, 1e-6);
  EXPECT_NEAR(cell(0).mean().x, 0.25, 1e-6);
  EXPECT_NEAR(cell(1).n, 0.75, 1e-6);
  EXPECT_NEAR(cell(1).mean().x, 0.5 / 0.75, 1e-6);
  EXPECT_EQ(cell(2).n, 1.0);
  EXPECT_NE(cell(0).n, 1.0);  // a shared cell is never a single detection of clutter
  const double expected = -0.75 * std::log(0.75) - 3.0 * 0.25 * std::log(0.25) - 0.5 * std::log(0.5);
  EXPECT_NEAR(partitions_.log_count(0), expected, 1e-12);
  EXPECT_EQ(partitions_.labels(0)[0], list[0]);
  EXPECT_EQ(partitions_.labels(0)[1], list[1]);
  // Nothing to share: no partition.
  const std::vector<double> hard = {1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  partitions_.add_shared(model_, objects, hard, 2, Rest::kLinked);
  EXPECT_EQ(partitions_.size(), 1u);
}

TEST_F(PhdPartitions, NumbersStayWithinTheCapacity) {
  const Capacity capacity;
  Detections many;
  support::Random random(5);
  for (std::size_t i = 0; i < capacity.group_measurements; ++i) {
    many.push_back(support::detection_at({support::uniform(random, 0.0, 20.0), support::uniform(random, 0.0, 20.0)},
                                         {0.0, 0.0}, 0.0, 0.0));
  }
  begin(many);
  partitions_.add_by_distance(model_);
  EXPECT_EQ(cells(0).size(), 1u);
  partitions_.add_split([](const Cell<double>&) { return 1.0; });
  EXPECT_LE(partitions_.size(), capacity.partitions);
  EXPECT_LE(partitions_.cells().size(), capacity.cells);
  EXPECT_EQ(all().size(), partitions_.size());
}

// --- Filter ---------------------------------------------------------------------------------------------------------

constexpr double kStep_s = 0.1;

/// A car that moves straight on.
struct Car {
  Eigen::Vector4d state = Eigen::Vector4d::Zero();
  Eigen::Matrix2d extent = Eigen::Vector2d(4.0, 1.0).asDiagonal();
  void move() { state.head<2>() += kStep_s * state.tail<2>(); }
};

void add(Detections& list, const Detections& more) {
  list.insert(list.end(), more.begin(), more.end());
}

void add_clutter(support::Random& random, ListModel& model, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d place_m(support::uniform(random, -80.0, 120.0), support::uniform(random, -25.0, 25.0));
    model.list.push_back(
        support::detection_at(place_m, {support::uniform(random, -20.0, 20.0), 0.0}, 0.0, car_log_clutter(model)));
  }
}

/// Cars with 8 detections each and clutter; the cars are born in the first scan.
void make_scan(support::Random& random, ListModel& model, std::vector<Car>& cars, bool is_first, std::size_t clutter) {
  model.list.clear();
  model.born.clear();
  for (Car& car : cars) {
    if (is_first) model.born.push_back(car_birth(car.state, 0.1));
    if (!is_first) car.move();
    add(model.list, support::draw_detections(random, car.state, car.extent, model.sensor, 8, car_log_clutter(model)));
  }
  add_clutter(random, model, clutter);
}

std::size_t likely(const Filter& filter) {
  const auto estimates = filter.estimates();
  return static_cast<std::size_t>(
      std::count_if(estimates.begin(), estimates.end(), [](const ObjectEstimate& e) { return e.existence > 0.5; }));
}

TEST(PhdFilter, OneObjectWithoutClutterIsTheSingleObjectFilter) {
  for (const bool has_range_rates : {false, true}) {
    ListModel model = car_model(has_range_rates);
    PhdFilter filter({}, {});
    support::Random random(3);
    Car car{{40.0, 5.0, 8.0, -2.0}};
    const PoissonComponent birth = car_birth({39.0, 6.0, 7.0, -1.0}, 0.05);
    support::Reference expected = support::reference_of(birth.component);
    for (int k = 0; k < 10; ++k) {
      model.born = k == 0 ? std::vector{birth} : std::vector<PoissonComponent>{};
      if (k > 0) {
        car.move();
        support::predict_reference(expected, model.motion, kStep_s);
      }
      model.list = support::draw_detections(random, car.state, car.extent, model.sensor, 8, -20.0);
      expected = support::updated_reference(expected, model.sensor, model.list);
      filter.step(model, kStep_s);
      ASSERT_EQ(filter.estimates().size(), 1u) << k;
      const ObjectEstimate& e = filter.estimates()[0];
      support::expect_equal(support::reference_of(*e.component), expected, 1e-6);
      EXPECT_EQ(e.detections, 8.0);
      EXPECT_TRUE(e.detected);
      EXPECT_GT(e.existence, 0.99);
      EXPECT_NEAR(filter.cardinality(), 1.0, 0.01) << k;
      for (const double p : filter.explained()) EXPECT_NEAR(p, k == 0 ? 0.0 : 1.0, 0.01);
    }
  }
}

TEST(PhdFilter, FirstDetectionAndMissHaveTheWeightsOfThePaper) {
  // One measurement and one birth: d = 1 + w L, weight = w L / d; then a scan without detection: published, weight p_S
  // q w; else that of a Bernoulli component.
  for (const bool as_published : {false, true}) {
    ListModel model = car_model(false);
    Parameters parameters;
    parameters.as_published = as_published;
    parameters.prune_weight = parameters.report_existence = 1e-6;
    PhdFilter filter(parameters, {});
    const PoissonComponent birth = car_birth({40.0, 5.0, 8.0, -2.0}, 0.2);
    model.born = {birth};
    model.list = {support::detection_at({40.5, 5.5}, {0.0, 0.0}, 0.0, -10.0)};
    const double likelihood =
        std::exp(support::log_likelihood_reference(support::reference_of(birth.component), model.sensor, model.list));
    filter.step(model, kStep_s);
    const double weight = 0.2 * likelihood / (1.0 + 0.2 * likelihood);
    ASSERT_GT(weight, 0.1);
    ASSERT_LT(weight, 0.95);
    EXPECT_NEAR(filter.cardinality(), weight, 1e-9);
    ASSERT_EQ(filter.estimates().size(), 1u);
    EXPECT_NEAR(filter.estimates()[0].existence, weight, 1e-9);

    model.born.clear();
    model.list.clear();
    support::Reference predicted = support::reference_of(*filter.estimates()[0].component);
    support::predict_reference(predicted, model.motion, kStep_s);
    const double none = std::exp(support::log_count_reference(predicted, model.sensor.exposure, 0.0));
    const double q = 1.0 - model.sensor.detection_probability * (1.0 - none);
    filter.step(model, kStep_s);
    const double r = model.survival * weight;
    const double missed = as_published ? q * r : q * r / (1.0 - r + q * r);
    EXPECT_NEAR(filter.cardinality(), missed, 1e-9);
    ASSERT_EQ(filter.estimates().size(), 1u);
    EXPECT_FALSE(filter.estimates()[0].detected);
    EXPECT_NEAR(filter.estimates()[0].existence, missed, 1e-9);
  }
}

TEST(PhdFilter, DetectedObjectIsNotAlsoMissed) {
  // The published first sum keeps q of a detected object; with (7), one object stays one.
  for (const bool as_published : {false, true}) {
    ListModel model = car_model(false);
    Parameters parameters;
    parameters.as_published = as_published;
    PhdFilter filter(parameters, {});
    support::Random random(4);
    std::vector<Car> cars = {Car{{40.0, 5.0, 8.0, -2.0}}};
    for (int k = 0; k < 30; ++k) {
      make_scan(random, model, cars, k == 0, 0);
      filter.step(model, kStep_s);
    }
    EXPECT_NEAR(filter.cardinality(), as_published ? 1.1 : 1.0, 0.03);
    ASSERT_EQ(filter.estimates().size(), 1u);
  }
}

TEST(PhdFilter, MissedObjectKeepsItsIdentityUntilItIsDetectedAgain) {
  ListModel model = car_model(false);
  PhdFilter filter({}, {});
  support::Random random(6);
  std::vector<Car> cars = {Car{{40.0, 5.0, 8.0, -2.0}}};
  std::uint32_t id = 0;
  for (int k = 0; k < 30; ++k) {
    make_scan(random, model, cars, k == 0, 0);
    const bool is_missed = k == 10 || k == 20 || k == 21;
    if (is_missed) model.list.clear();
    filter.step(model, kStep_s);
    ASSERT_EQ(filter.estimates().size(), 1u) << k;
    if (k == 0) id = filter.estimates()[0].id;
    EXPECT_EQ(filter.estimates()[0].id, id);
    EXPECT_EQ(filter.estimates()[0].detected, !is_missed);
    if (k == 10) {
      EXPECT_GT(filter.estimates()[0].existence, 0.8);
      EXPECT_NEAR(filter.cardinality(), filter.estimates()[0].existence, 1e-9);
    }
  }
  EXPECT_GT(filter.estimates()[0].existence, 0.99);
}

TEST(PhdFilter, TwoObjectsThatBecomeAlikeStayTwo) {
  ListModel model = car_model(false);
  PhdFilter filter({}, {});
  support::Random random(8);
  std::vector<Car> cars = {Car{{40.0, 6.0, 8.0, -3.0}}, Car{{40.0, -6.0, 8.0, 3.0}}};
  for (int k = 0; k < 40; ++k) {
    if (k == 18) cars[0].state[3] = cars[1].state[3] = 0.0;  // one beside the other from now on
    make_scan(random, model, cars, k == 0, 0);
    filter.step(model, kStep_s);
    EXPECT_EQ(likely(filter), 2u) << k;
  }
}

TEST(PhdFilter, CardinalityIsTheNumberOfSeparateObjects) {
  for (const bool has_range_rates : {false, true}) {
    ListModel model = car_model(has_range_rates);
    PhdFilter filter({}, {});
    support::Random random(7);
    std::vector<Car> cars;
    for (int i = 0; i < 6; ++i) cars.push_back(Car{{15.0 * i - 30.0, i % 2 == 0 ? 8.0 : -8.0, 2.0, 0.0}});
    std::set<std::uint32_t> ids;
    for (int k = 0; k < 40; ++k) {
      make_scan(random, model, cars, k == 0, 15);
      filter.step(model, kStep_s);
      if (k < 5) continue;
      EXPECT_NEAR(filter.cardinality(), 6.0, 0.7) << k;
      EXPECT_EQ(likely(filter), 6u) << k;
      std::set<std::uint32_t> of_scan;
      for (const ObjectEstimate& e : filter.estimates()) {
        EXPECT_TRUE(of_scan.insert(e.id).second) << "identity twice in a scan";
        if (e.existence > 0.5) ids.insert(e.id);
      }
      // The first 48 measurements are of the cars.
      const auto explained = filter.explained();
      for (std::size_t i = 0; i < explained.size(); ++i) {
        EXPECT_GE(explained[i], 0.0);
        EXPECT_LE(explained[i], 1.0 + 1e-9);
      }
      double of_cars = 0.0;
      for (std::size_t i = 0; i < 48; ++i) of_cars += explained[i] / 48.0;
      EXPECT_GT(of_cars, 0.95) << k;
    }
    EXPECT_EQ(ids.size(), 6u);
  }
}

TEST(PhdFilter, ObjectsThatCrossStayTwo) {
  ListModel model = car_model(false);
  PhdFilter filter({}, {});
  support::Random random(8);
  std::vector<Car> cars = {Car{{0.0, 0.0, 8.0, 0.0}}, Car{{32.0, 0.4, -8.0, 0.0}}};
  int lost = 0;
  for (int k = 0; k < 40; ++k) {
    make_scan(random, model, cars, k == 0, 5);
    filter.step(model, kStep_s);
    if (likely(filter) != 2) ++lost;
  }
  EXPECT_LE(lost, 1);
}

TEST(PhdFilter, PublishedComponentMayBeTwoObjectsWithTheirOwnIdentities) {
  // A second later, two clusters are as likely to be of the one car known, and no births are expected.
  for (const bool as_published : {false, true}) {
    ListModel model = car_model(false);
    Parameters parameters;
    parameters.as_published = as_published;
    PhdFilter filter(parameters, {});
    support::Random random(9);
    Car car{{20.0, 0.0, 8.0, 0.0}};
    model.born = {car_birth(car.state, 0.1)};
    model.list = support::draw_detections(random, car.state, car.extent, model.sensor, 8, -20.0);
    filter.step(model, kStep_s);
    ASSERT_EQ(filter.estimates().size(), 1u);
    const std::uint32_t id = filter.estimates()[0].id;
    model.born.clear();
    model.list.clear();
    for (const double y_m : {-2.5, 2.5}) {
      const Eigen::Vector4d state(28.0, y_m, 8.0, 0.0);
      add(model.list, support::draw_detections(random, state, car.extent, model.sensor, 8, -20.0));
    }
    filter.step(model, 1.0);
    ASSERT_EQ(likely(filter), as_published ? 2u : 1u);
    const ObjectEstimate &a = filter.estimates()[0], &b = filter.estimates().back();
    EXPECT_EQ(a.id == b.id, !as_published);
    EXPECT_TRUE(a.id == id || b.id == id);
    EXPECT_EQ(a.detections, 8.0);
  }
}

TEST(PhdFilter, SpentWorkBudgetIsReportedAndObjectsStay) {
  ListModel model = car_model(false);
  Parameters parameters;
  parameters.work_budget = 40;
  PhdFilter limited(parameters, {}), unlimited({}, {});
  support::Random random(10);
  std::vector<Car> cars = {Car{{0.0, 0.0, 8.0, 0.0}}, Car{{60.0, 6.0, -8.0, 0.0}}};
  int reached = 0;
  for (int k = 0; k < 30; ++k) {
    make_scan(random, model, cars, k == 0, k < 10 ? 0 : 60);
    limited.step(model, kStep_s);
    unlimited.step(model, kStep_s);
    EXPECT_FALSE(unlimited.work().budget_reached);
    EXPECT_EQ(limited.work().budget_reached, limited.work().likelihood_evaluations > parameters.work_budget);
    if (limited.work().budget_reached) {
      ++reached;
      EXPECT_LT(limited.work().likelihood_evaluations, unlimited.work().likelihood_evaluations);
    }
    if (k >= 5) {
      EXPECT_EQ(likely(limited), 2u) << k;
    }
  }
  EXPECT_GT(reached, 10);
}

TEST(PhdFilter, StepAllocatesNothing) {
  for (const bool has_range_rates : {false, true}) {
    ListModel model = car_model(has_range_rates);
    model.anywhere_per_m2 = 1e-4;
    model.newborn_prior = car_birth({0.0, 0.0, 0.0, 0.0}, 1.0).component;
    model.newborn_prior.position_covariance = {900.0, 0.0, 900.0};
    PhdFilter filter({}, {});
    support::Random random(11);
    std::vector<Car> cars;
    for (int i = 0; i < 10; ++i) cars.push_back(Car{{7.0 * i - 30.0, 4.0 * (i % 3) - 4.0, 6.0 - 3.0 * (i % 4), 0.0}});
    std::uint64_t allocations = 0;
    for (int k = 0; k < 40; ++k) {
      make_scan(random, model, cars, k == 0, k % 10 == 9 ? 800 : 40);
      const std::uint64_t before = runtime::counted_allocations();
      {
        const runtime::CountAllocations count;
        filter.step(model, kStep_s);
      }
      allocations += runtime::counted_allocations() - before;
    }
    EXPECT_EQ(allocations, 0u);
  }
}

TEST(PhdFilter, SameInputGivesTheSameOutput) {
  ListModel model = car_model(true);
  PhdFilter first({}, {}), second({}, {});
  support::Random random(12);
  std::vector<Car> other = {Car{{10.0, 0.0, 8.0, 0.0}}};
  for (int k = 0; k < 5; ++k) {  // what the second has seen before clear() does not matter
    make_scan(random, model, other, k == 0, 15);
    second.step(model, kStep_s);
  }
  second.clear();
  std::vector<Car> cars = {Car{{0.0, 0.0, 8.0, 0.0}}, Car{{32.0, 0.4, -8.0, 0.0}}, Car{{10.0, 9.0, 1.0, 0.0}}};
  for (int k = 0; k < 40; ++k) {
    make_scan(random, model, cars, k == 0, 15);
    first.step(model, kStep_s);
    second.step(model, kStep_s);
    EXPECT_EQ(first.work().likelihood_evaluations, second.work().likelihood_evaluations);
    ASSERT_EQ(first.estimates().size(), second.estimates().size());
    for (std::size_t i = 0; i < first.estimates().size(); ++i) {
      const ObjectEstimate &a = first.estimates()[i], &b = second.estimates()[i];
      EXPECT_EQ(a.existence, b.existence);
      EXPECT_EQ(a.component->position_m.x, b.component->position_m.x);
      EXPECT_EQ(a.component->velocity_mps.y, b.component->velocity_mps.y);
    }
    EXPECT_TRUE(std::equal(first.explained().begin(), first.explained().end(), second.explained().begin()));
  }
}

}  // namespace
}  // namespace boresight::tracking::phd
