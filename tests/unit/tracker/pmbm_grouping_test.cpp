// Which stored groups and measurements are solved together, by hand-made scenes.
#include <array>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/tracker/core/pmbm/grouping.hpp"
#include "tests/unit/tracker/list_model.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::pmbm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// 0.3 m of place and 1 m of detections about it in each direction: a gate of about 4 m.
LocalHypothesis stored_at(double x_m, double y_m = 0.0) {
  LocalHypothesis l;
  l.existence = 1.0;
  l.component.position_m = {x_m, y_m};
  l.component.position_covariance = {0.1, 0.0, 0.1};
  l.component.velocity_covariance = {1.0, 0.0, 1.0};
  l.component.extent_dof = 8.0;
  l.component.extent_scale = {8.0, 0.0, 8.0};
  return l;
}

struct GroupingScene {
  explicit GroupingScene(const Capacity& c = {}, bool has_range_rates = false)
      : capacity(c),
        model(support::car_model(has_range_rates)),
        poisson(Parameters{}, c),
        store(c),
        grouping(Parameters{}, c) {}
  void measure(double x_m, double y_m = 0.0, double range_rate_mps = 0.0) {
    model.list.push_back(support::detection_at({x_m, y_m}, {0.0, 0.0}, range_rate_mps, -8.0));
  }
  std::span<const WorkItem> find() {
    poisson.predict(model, 0.1);
    poisson.begin_scan(model);
    return grouping.find(model, poisson, store, work);
  }
  std::vector<std::size_t> groups(const WorkItem& item) const {
    return {grouping.groups(item).begin(), grouping.groups(item).end()};
  }
  std::vector<std::size_t> measurements(const WorkItem& item) const {
    return {grouping.measurements(item).begin(), grouping.measurements(item).end()};
  }

  Capacity capacity;
  support::ListModel model;
  PoissonPart poisson;
  GroupStore store;
  Grouping grouping;
  FilterWork work;
};

TEST(Grouping, GivesEachStoredGroupTheMeasurementsInItsGate) {
  GroupingScene s;
  ASSERT_TRUE(s.store.store_alone(1, stored_at(20.0)));
  ASSERT_TRUE(s.store.store_alone(2, stored_at(60.0)));
  s.measure(61.0);
  s.measure(19.0);
  s.measure(100.0);  // of nothing
  s.measure(22.0, 1.0);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(2));
  EXPECT_THAT(s.groups(items[0]), ElementsAre(1U)) << "the simpler first";
  EXPECT_THAT(s.measurements(items[0]), ElementsAre(0U));
  EXPECT_THAT(s.groups(items[1]), ElementsAre(0U));
  EXPECT_THAT(s.measurements(items[1]), ElementsAre(1U, 3U));
  EXPECT_EQ(s.work.cut_gates, 0U);
}

TEST(Grouping, JoinsGroupsThatShareAMeasurementOrLinkedMeasurements) {
  GroupingScene s;
  ASSERT_TRUE(s.store.store_alone(1, stored_at(20.0)));
  ASSERT_TRUE(s.store.store_alone(2, stored_at(25.0)));
  ASSERT_TRUE(s.store.store_alone(3, stored_at(60.0)));
  ASSERT_TRUE(s.store.store_alone(4, stored_at(71.0)));
  s.measure(22.5);  // in both gates
  s.measure(63.5);  // each in one gate, but within 5 m of each other
  s.measure(67.5);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(2));
  EXPECT_THAT(s.groups(items[0]), ElementsAre(0U, 1U));
  EXPECT_THAT(s.groups(items[1]), ElementsAre(2U, 3U));
  EXPECT_THAT(s.measurements(items[1]), ElementsAre(1U, 2U));
}

TEST(Grouping, KeepsGroupsWithoutMeasurementsApart) {
  GroupingScene s;
  ASSERT_TRUE(s.store.store_alone(1, stored_at(20.0)));
  ASSERT_TRUE(s.store.store_alone(2, stored_at(20.5)));
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(2));
  for (const WorkItem& item : items) EXPECT_THAT(s.measurements(item), IsEmpty());
}

TEST(Grouping, GatesByRangeRateToo) {
  GroupingScene s({}, true);
  ASSERT_TRUE(s.store.store_alone(1, stored_at(20.0)));
  s.measure(20.5, 0.0, 1.0);
  s.measure(20.5, 0.0, 6.0);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(1));
  EXPECT_THAT(s.measurements(items[0]), ElementsAre(0U));
}

TEST(Grouping, GivesNoMeasurementToWhatTheSensorCannotSee) {
  GroupingScene s;
  s.model.sensor.detection_probability = 1e-4;
  ASSERT_TRUE(s.store.store_alone(1, stored_at(20.0)));
  s.measure(20.0);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(1));
  EXPECT_THAT(s.measurements(items[0]), IsEmpty());
}

TEST(Grouping, PutsWhatMayBeNewLast) {
  GroupingScene s;
  s.model.anywhere_per_m2 = 1e-4;
  ASSERT_TRUE(s.store.store_alone(1, stored_at(20.0)));
  s.measure(80.0);
  s.measure(20.0);
  s.measure(82.0);
  s.measure(-50.0);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(3));
  EXPECT_THAT(s.groups(items[0]), ElementsAre(0U));
  EXPECT_THAT(s.measurements(items[0]), ElementsAre(1U));
  EXPECT_THAT(s.groups(items[1]), IsEmpty());
  EXPECT_THAT(s.groups(items[2]), IsEmpty());
}

TEST(Grouping, TakesMeasurementsNearThePoissonPart) {
  GroupingScene s;
  s.model.born = {support::car_birth({40.0, 0.0, 0.0, 0.0}, 0.1)};
  s.measure(44.0);
  s.measure(-44.0);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(1));
  EXPECT_THAT(s.measurements(items[0]), ElementsAre(0U));
}

TEST(Grouping, CutsConnectionsBeyondTheRoomOfAGroupAndCountsThem) {
  Capacity capacity;
  capacity.group_objects = 4;
  GroupingScene s(capacity);
  for (std::uint32_t id = 0; id < 3; ++id) ASSERT_TRUE(s.store.store_alone(id, stored_at(20.0 + 4.0 * id)));
  s.measure(22.0);
  s.measure(26.0);
  const auto items = s.find();
  EXPECT_THAT(items, SizeIs(2));
  EXPECT_GT(s.work.cut_gates, 0U);
  EXPECT_EQ(s.work.dropped_detections + s.work.dropped_objects, 0U) << "nothing is lost";
  std::size_t groups = 0, measurements = 0;
  for (const WorkItem& item : items) {
    EXPECT_LE(item.groups, 2U);
    groups += item.groups;
    measurements += item.measurements;
  }
  EXPECT_EQ(groups, 3U);
  EXPECT_EQ(measurements, 2U);
}

TEST(Grouping, GivesMeasurementsToAGroupThatFillsMoreThanHalfOfItsRoom) {
  Capacity capacity;
  capacity.group_objects = 4;
  GroupingScene s(capacity);
  Group group(capacity);
  ASSERT_TRUE(group.add_row(0.0));
  for (std::uint32_t id = 1; id <= 3; ++id) {
    ASSERT_TRUE(group.add_column(id));
    group.at(0, id - 1) = static_cast<std::int16_t>(group.add_local(stored_at(20.0 + id)));
  }
  const std::array<std::size_t, 3> all{0, 1, 2};
  ASSERT_TRUE(s.store.store(group, all));
  s.measure(21.0);
  s.measure(23.0);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(1));
  EXPECT_THAT(s.groups(items[0]), ElementsAre(0U));
  EXPECT_THAT(s.measurements(items[0]), ElementsAre(0U, 1U));
  EXPECT_EQ(s.work.cut_gates, 0U);
}

TEST(Grouping, LooksAtNoMoreMeasurementsThanThereIsRoomForAndCountsTheOthers) {
  Capacity capacity;
  capacity.measurements = 3;
  GroupingScene s(capacity);
  ASSERT_TRUE(s.store.store_alone(1, stored_at(20.0)));
  for (int i = 0; i < 5; ++i) s.measure(20.0 + 0.1 * i);
  const auto items = s.find();
  ASSERT_THAT(items, SizeIs(1));
  EXPECT_THAT(s.measurements(items[0]), ElementsAre(0U, 1U, 2U));
  EXPECT_EQ(s.work.dropped_detections, 2U);
  EXPECT_EQ(s.work.cut_gates, 0U);
}

TEST(Grouping, EqualsAConnectedComponentSearchOfRandomScenes) {
  support::Random random(1);
  for (int run = 0; run < 50; ++run) {
    GroupingScene s;
    s.model.anywhere_per_m2 = 1e-4;
    const std::size_t objects = 1 + random() % 12, n = random() % 60;
    std::vector<LocalHypothesis> locals;
    for (std::uint32_t i = 0; i < objects; ++i) {
      locals.push_back(stored_at(support::uniform(random, -60.0, 60.0), support::uniform(random, -20.0, 20.0)));
      ASSERT_TRUE(s.store.store_alone(i, locals.back()));
    }
    for (std::size_t i = 0; i < n; ++i)
      s.measure(support::uniform(random, -60.0, 60.0), support::uniform(random, -20.0, 20.0));
    // Labels spread until nothing changes.
    std::vector<std::size_t> label(n + objects);
    for (std::size_t i = 0; i < label.size(); ++i) label[i] = i;
    const auto connected = [&](std::size_t a, std::size_t b) {
      if (a < n && b < n) return s.model.are_linked(s.model.list[a], s.model.list[b]);
      if (a >= n && b >= n) return false;
      const Prediction<double> p(locals[std::max(a, b) - n].component, s.model.sensor);
      return p.place_distance(s.model.list[std::min(a, b)].position_m) <= Parameters{}.gate_chi2;
    };
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t a = 0; a < label.size(); ++a) {
        for (std::size_t b = 0; b < label.size(); ++b) {
          if (label[a] <= label[b] || !connected(a, b)) continue;
          label[a] = label[b];
          changed = true;
        }
      }
    }
    std::size_t seen = 0;
    for (const WorkItem& item : s.find()) {
      std::vector<std::size_t> members = s.measurements(item);
      for (const std::size_t g : s.groups(item)) members.push_back(n + g);
      seen += members.size();
      for (const std::size_t m : members) EXPECT_EQ(label[m], label[members[0]]);
      EXPECT_EQ(static_cast<std::size_t>(std::count(label.begin(), label.end(), label[members[0]])), members.size());
    }
    EXPECT_EQ(seen, n + objects);
    EXPECT_EQ(s.work.cut_gates, 0U);
  }
}

}  // namespace
}  // namespace boresight::tracking::pmbm
