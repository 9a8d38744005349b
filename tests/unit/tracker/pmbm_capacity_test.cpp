// The PMBM filter at its limits: capacities, work budget, memory, repetition.
#include <cmath>
#include <cstring>
#include <set>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/tracker/core/pmbm/pmbm_filter.hpp"
#include "tests/unit/tracker/list_model.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::pmbm {
namespace {

using support::ListModel;

constexpr double kScan_s = 0.1;

/// Cars that come and go among clutter. Births are known places, or anywhere.
class BusyScene {
 public:
  BusyScene(std::uint64_t seed, bool has_range_rates, bool anywhere, double clutter, std::size_t places)
      : model(support::car_model(has_range_rates)), random_(seed), clutter_(clutter) {
    for (std::size_t i = 0; i < places; ++i) {
      places_.emplace_back(support::uniform(random_, -80.0, 80.0), support::uniform(random_, -40.0, 40.0),
                           support::uniform(random_, -8.0, 8.0), support::uniform(random_, -8.0, 8.0));
    }
    log_clutter_ = std::log(std::max(1.0, clutter) / (200.0 * 100.0)) - (has_range_rates ? std::log(40.0) : 0.0);
    if (!anywhere) return;
    model.newborn_prior = support::car_birth(Eigen::Vector4d::Zero(), 1.0).component;
    model.newborn_prior.position_covariance = {900.0, 0.0, 900.0};
    model.newborn_prior.velocity_covariance = {100.0, 0.0, 100.0};
    model.anywhere_per_m2 = 1e-4;
  }
  /// The lists of the next scan.
  void next() {
    std::erase_if(cars_, [&](const Eigen::Vector4d&) { return support::uniform(random_, 0.0, 1.0) > 0.98; });
    model.born.clear();
    for (const Eigen::Vector4d& place : places_) {
      if (model.anywhere_per_m2 <= 0.0) model.born.push_back(support::car_birth(place, 0.02));
      if (support::uniform(random_, 0.0, 1.0) < 0.03) cars_.push_back(place);
    }
    model.list.clear();
    const Eigen::Matrix2d extent = Eigen::Vector2d(4.0, 1.0).asDiagonal();
    for (Eigen::Vector4d& car : cars_) {
      car.head<2>() += kScan_s * car.tail<2>();
      if (support::uniform(random_, 0.0, 1.0) > model.sensor.detection_probability) continue;
      const auto n = static_cast<std::size_t>(std::poisson_distribution<int>(8.0)(random_));
      const support::Detections z = support::draw_detections(random_, car, extent, model.sensor, n, log_clutter_);
      model.list.insert(model.list.end(), z.begin(), z.end());
    }
    for (int i = std::poisson_distribution<int>(std::max(1e-9, clutter_))(random_); i > 0; --i) {
      const double x = support::uniform(random_, -100.0, 100.0), y = support::uniform(random_, -50.0, 50.0);
      const double rate_mps = support::uniform(random_, -20.0, 20.0);
      model.list.push_back(support::detection_at({x, y}, {0.0, 0.0}, rate_mps, log_clutter_));
    }
  }

  ListModel model;

 private:
  support::Random random_;
  double clutter_, log_clutter_ = 0.0;
  std::vector<Eigen::Vector4d> places_, cars_;
};

void expect_sound(const PmbmFilter& filter, const Capacity& capacity, const ListModel& model) {
  ASSERT_LE(filter.estimates().size(), capacity.objects);
  ASSERT_EQ(filter.explained().size(), model.list.size());
  std::set<std::uint32_t> ids;
  for (const ObjectEstimate& e : filter.estimates()) {
    ids.insert(e.id);
    ASSERT_TRUE(e.existence >= 0.0 && e.existence <= 1.0 + 1e-9) << e.existence;
    ASSERT_TRUE(e.component != nullptr);
    ASSERT_TRUE(std::isfinite(e.component->position_m.x) && std::isfinite(e.component->velocity_mps.y));
    ASSERT_GT(determinant(e.component->position_covariance), 0.0);
    ASSERT_GT(determinant(e.component->extent_scale), 0.0);
  }
  ASSERT_EQ(ids.size(), filter.estimates().size()) << "an identity twice";
  for (const double x : filter.explained()) ASSERT_TRUE(x >= 0.0 && x <= 1.0 + 1e-9) << x;
}

Capacity tiny_capacity() {
  Capacity c;
  c.measurements = 64;
  c.objects = 4;
  c.local_hypotheses = 8;
  c.groups = 2;
  c.group_objects = 4;
  c.group_measurements = 4;
  c.rows = 2;
  c.candidates = 2;
  c.poisson_components = 3;
  return c;
}

TEST(PmbmCapacity, TinyCapacitiesNeverCrashAndReportDroppedObjects) {
  for (const bool anywhere : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      BusyScene scene(seed, seed % 2 == 0, anywhere, 10.0, 6);
      const Capacity capacity = tiny_capacity();
      PmbmFilter filter(Parameters{}, capacity);
      std::uint64_t dropped = 0;
      for (int scan = 0; scan < 100; ++scan) {
        scene.next();
        filter.step(scene.model, kScan_s);
        expect_sound(filter, capacity, scene.model);
        dropped += filter.work().dropped_objects;
      }
      EXPECT_GT(dropped, 0U);
    }
  }
}

TEST(PmbmCapacity, AnyOneCapacityMayBeTheSmallest) {
  for (int which = 0; which < 9; ++which) {
    Capacity capacity;
    switch (which) {
      case 0:
        capacity.measurements = 5;
        break;
      case 1:
        capacity.objects = 1;
        break;
      case 2:
        capacity.local_hypotheses = 1;
        break;
      case 3:
        capacity.groups = 1;
        break;
      case 4:
        capacity.group_objects = 1;
        break;
      case 5:
        capacity.group_measurements = 1;
        break;
      case 6:
        capacity.rows = 1;
        break;
      case 7:
        capacity.candidates = 1;
        break;
      default:
        capacity.poisson_components = 1;
        break;
    }
    for (const bool anywhere : {false, true}) {
      BusyScene scene(7, true, anywhere, 15.0, 6);
      PmbmFilter filter(Parameters{}, capacity);
      for (int scan = 0; scan < 60; ++scan) {
        scene.next();
        filter.step(scene.model, kScan_s);
        expect_sound(filter, capacity, scene.model);
      }
    }
  }
}

TEST(PmbmCapacity, EstablishedObjectsStayWhenClutterFillsTheRoom) {
  ListModel model = support::car_model(false);
  support::Random random(3);
  model.newborn_prior = support::car_birth(Eigen::Vector4d::Zero(), 1.0).component;
  model.newborn_prior.position_covariance = {900.0, 0.0, 900.0};
  model.anywhere_per_m2 = 1e-4;
  Capacity capacity;
  capacity.objects = 6;
  PmbmFilter filter(Parameters{}, capacity);
  const Eigen::Matrix2d extent = Eigen::Vector2d(4.0, 1.0).asDiagonal();
  std::set<std::uint32_t> established;
  for (int scan = 0; scan < 20; ++scan) {
    model.list.clear();
    for (int i = 0; i < 4; ++i) {
      const auto z = support::draw_detections(random, {30.0 * i, 0.0, 0.0, 0.0}, extent, model.sensor, 6, -12.0);
      model.list.insert(model.list.end(), z.begin(), z.end());
    }
    // From the tenth scan on, more tentative objects at places of their own than there is room for.
    for (int i = 0; scan >= 10 && i < 40; ++i) {
      model.list.push_back(support::detection_at({-300.0 + 15.0 * i, 100.0 + 20.0 * scan}, {0.0, 0.0}, 0.0, -12.0));
    }
    filter.step(model, kScan_s);
    if (scan == 9) {
      for (const ObjectEstimate& e : filter.estimates()) established.insert(e.id);
      ASSERT_EQ(established.size(), 4U);
    }
    if (scan < 10) continue;
    EXPECT_GT(filter.work().dropped_objects, 0U) << "the room is full";
    for (const std::uint32_t id : established) {
      EXPECT_TRUE(std::any_of(filter.estimates().begin(), filter.estimates().end(),
                              [id](const ObjectEstimate& e) { return e.id == id; }))
          << "object " << id << ", scan " << scan;
    }
  }
}

TEST(PmbmCapacity, HundredsOfMeasurementsAtOnePlaceAreOneObjectOrSeveralButNoFault) {
  support::Random random(5);
  for (const std::size_t n : {100U, 255U, 256U, 257U, 500U, 1000U}) {
    for (const bool anywhere : {false, true}) {
      ListModel model = support::car_model(true);
      if (anywhere) {
        model.anywhere_per_m2 = 1e-4;
        model.newborn_prior = support::car_birth(Eigen::Vector4d::Zero(), 1.0).component;
        model.newborn_prior.position_covariance = {900.0, 0.0, 900.0};
      }
      const Capacity capacity;
      PmbmFilter filter(Parameters{}, capacity);
      const Eigen::Vector4d truth(30.0, 5.0, 4.0, 0.0);
      for (int scan = 0; scan < 4; ++scan) {
        model.born = {support::car_birth(truth, 0.1)};
        model.list =
            support::draw_detections(random, truth, Eigen::Vector2d(4.0, 1.0).asDiagonal(), model.sensor, n, -9.0);
        filter.step(model, kScan_s);
        expect_sound(filter, capacity, model);
        ASSERT_FALSE(filter.estimates().empty()) << n;
        EXPECT_EQ(filter.work().cut_gates > 0, n > capacity.group_measurements) << n << " detections";
        EXPECT_EQ(filter.work().dropped_detections, 0U);
      }
    }
  }
}

TEST(PmbmCapacity, MeasurementsAtExactlyOnePlaceAreNoFault) {
  ListModel model = support::car_model(true);
  const Capacity capacity;
  PmbmFilter filter(Parameters{}, capacity);
  for (int scan = 0; scan < 30; ++scan) {
    model.born = {support::car_birth({30.0, 5.0, 0.0, 0.0}, 0.1)};
    model.list.assign(50, support::detection_at({30.0, 5.0}, {0.0, 0.0}, 0.0, -9.0));
    filter.step(model, kScan_s);
    expect_sound(filter, capacity, model);
    EXPECT_FALSE(filter.estimates().empty());
  }
}

TEST(PmbmCapacity, EmptyScansAndTheFirstScanAreNoFault) {
  ListModel model = support::car_model(true);
  const Capacity capacity;
  PmbmFilter filter(Parameters{}, capacity);
  for (int scan = 0; scan < 5; ++scan) {
    filter.step(model, scan == 0 ? 0.0 : kScan_s);
    expect_sound(filter, capacity, model);
    EXPECT_TRUE(filter.estimates().empty());
    EXPECT_EQ(filter.work().likelihood_evaluations, 0U);
  }
  model.born = {support::car_birth({30.0, 5.0, 0.0, 0.0}, 0.1)};
  filter.step(model, kScan_s);
  EXPECT_TRUE(filter.estimates().empty());
}

// The work budget.

/// Cars 2 m apart in five rows of six: nothing can be distinguished for sure.
support::Detections crowd_detections(support::Random& random, ListModel& model) {
  const Eigen::Matrix2d extent = Eigen::Vector2d(4.0, 1.0).asDiagonal();
  support::Detections all;
  model.born.clear();
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector4d truth(30.0 + 2.0 * (i % 6), 2.0 * (i / 6), 0.0, 0.0);
    model.born.push_back(support::car_birth(truth, 0.05));
    const auto z = support::draw_detections(random, truth, extent, model.sensor, 8, -9.0);
    all.insert(all.end(), z.begin(), z.end());
  }
  return all;
}

TEST(PmbmBudget, BoundsTheWorkOfACrowdAndIsReported) {
  for (const std::uint32_t budget : {0U, 200U, 2000U, 6000U}) {
    support::Random random(6);
    ListModel model = support::car_model(false);
    Parameters parameters;
    parameters.work_budget = budget;
    PmbmFilter filter(parameters, Capacity{});
    std::size_t reached = 0;
    for (int scan = 0; scan < 30; ++scan) {
      model.list = crowd_detections(random, model);
      filter.step(model, kScan_s);
      expect_sound(filter, Capacity{}, model);
      // The step that spends the rest of the budget is finished: one pass over the measurements and cells of a group.
      EXPECT_LT(filter.work().likelihood_evaluations, budget + 2000U);
      // A search that ended at its share of the budget is reported, too.
      EXPECT_TRUE(filter.work().budget_reached || filter.work().likelihood_evaluations <= budget);
      EXPECT_FALSE(filter.estimates().empty()) << "what is known stays";
      reached += filter.work().budget_reached ? 1 : 0;
    }
    EXPECT_GT(reached, 0U) << budget;
  }
}

TEST(PmbmBudget, WithoutAnySearchObjectsFarApartAreStillTracked) {
  support::Random random(7);
  ListModel model = support::car_model(false);
  Parameters parameters;
  parameters.work_budget = 0;
  PmbmFilter filter(parameters, Capacity{});
  for (int scan = 0; scan < 20; ++scan) {
    model.list.clear();
    model.born.clear();
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector4d truth(30.0 + 20.0 * i, 0.0, 0.0, 0.0);
      if (scan == 0) model.born.push_back(support::car_birth(truth, 0.05));
      const auto z =
          support::draw_detections(random, truth, Eigen::Vector2d(4.0, 1.0).asDiagonal(), model.sensor, 8, -9.0);
      model.list.insert(model.list.end(), z.begin(), z.end());
    }
    filter.step(model, kScan_s);
    ASSERT_EQ(filter.estimates().size(), 5U) << "scan " << scan;
  }
}

// Repetition and memory.

bool are_same(const PmbmFilter& a, const PmbmFilter& b, bool with_ids) {
  if (a.estimates().size() != b.estimates().size() || a.explained().size() != b.explained().size()) return false;
  for (std::size_t i = 0; i < a.estimates().size(); ++i) {
    const ObjectEstimate &x = a.estimates()[i], &y = b.estimates()[i];
    if (with_ids && x.id != y.id) return false;
    if (x.existence != y.existence || x.source_existence != y.source_existence || x.detections != y.detections)
      return false;
    const Component<double>&p = *x.component, &q = *y.component;
    if (p.position_m.x != q.position_m.x || p.position_m.y != q.position_m.y || p.velocity_mps.x != q.velocity_mps.x ||
        p.position_covariance.xy != q.position_covariance.xy || p.extent_scale.xx != q.extent_scale.xx ||
        p.rate_shape != q.rate_shape || p.velocity_covariance.yy != q.velocity_covariance.yy) {
      return false;
    }
  }
  return std::equal(a.explained().begin(), a.explained().end(), b.explained().begin());
}

TEST(PmbmFilter, GivesTheSameBitsForTheSameInput) {
  BusyScene one(11, true, false, 60.0, 8), other(11, true, false, 60.0, 8);
  PmbmFilter a(Parameters{}, Capacity{}), b(Parameters{}, Capacity{});
  for (int scan = 0; scan < 150; ++scan) {
    one.next();
    other.next();
    a.step(one.model, kScan_s);
    b.step(other.model, kScan_s);
    ASSERT_TRUE(are_same(a, b, true)) << "scan " << scan;
    ASSERT_EQ(a.work().likelihood_evaluations, b.work().likelihood_evaluations);
  }
}

TEST(PmbmFilter, ClearedGivesTheSameBitsAsANewOneButOtherIdentities) {
  BusyScene before(12, false, true, 30.0, 8), one(13, false, true, 60.0, 8), other(13, false, true, 60.0, 8);
  PmbmFilter used(Parameters{}, Capacity{}), fresh(Parameters{}, Capacity{});
  for (int scan = 0; scan < 50; ++scan) {
    before.next();
    used.step(before.model, kScan_s);
  }
  used.clear();
  for (int scan = 0; scan < 100; ++scan) {
    one.next();
    other.next();
    used.step(one.model, kScan_s);
    fresh.step(other.model, kScan_s);
    ASSERT_TRUE(are_same(used, fresh, false)) << "scan " << scan;
  }
}

TEST(PmbmFilter, AllocatesNothingOverALongSceneOfBirthsDeathsAndClutter) {
  for (const bool anywhere : {false, true}) {
    BusyScene scene(14, true, anywhere, 100.0, 10);
    PmbmFilter filter(Parameters{}, Capacity{});
    std::size_t most = 0;
    const std::uint64_t before = runtime::counted_allocations();
    for (int scan = 0; scan < 500; ++scan) {
      scene.next();
      const runtime::CountAllocations counting;
      filter.step(scene.model, kScan_s);
      most = std::max(most, filter.estimates().size());
    }
    EXPECT_EQ(runtime::counted_allocations(), before);
    EXPECT_GT(most, 8U);
  }
}

TEST(PmbmFilter, AllocatesNothingWhereCapacitiesAreReached) {
  BusyScene scene(15, false, true, 40.0, 10);
  PmbmFilter filter(Parameters{}, tiny_capacity());
  const std::uint64_t before = runtime::counted_allocations();
  for (int scan = 0; scan < 200; ++scan) {
    scene.next();
    const runtime::CountAllocations counting;
    filter.step(scene.model, kScan_s);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::tracking::pmbm
