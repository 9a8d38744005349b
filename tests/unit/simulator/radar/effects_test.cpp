#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/simulator/radar/blockage.hpp"
#include "services/simulator/random.hpp"
#include "tests/unit/simulator/radar/bench_scene.hpp"

namespace boresight::simulator {
namespace {

/// Rails, a roadside and traffic, with all random effects enabled.
struct Road : Bench {
  explicit Road(std::size_t scatterers = 400, int rail_pieces = 30, std::uint32_t cars = 12) {
    effects = RadarEffects{};
    effects.clutter_per_scan = 0.0;
    effects.sensitivity.max_detections = 1024;
    config.field_of_view.range_max_m = 100.0;
    ego_body = {-5.0, 0.3, 0.9, 0.15, 1.5};
    Stream stream(1, "road");
    for (std::size_t i = 0; i < scatterers; ++i) {
      scene.scatterers.push_back({{stream.uniform(-150.0, 150.0), stream.uniform(8.0, 40.0) * (i % 2 == 0 ? 1.0 : -1.0),
                                   stream.uniform(0.2, 5.0)},
                                  stream.uniform(-5.0, 15.0)});
    }
    for (int i = 0; i < rail_pieces; ++i) {
      const double x = -150.0 + 300.0 * i / rail_pieces;
      for (const double y : {-7.0, 7.0}) add_rail({x, y}, {x + 300.0 / rail_pieces, y});
    }
    for (std::uint32_t id = 1; id <= cars; ++id) {
      const double x = 15.0 * id - 80.0, y = id % 2 == 0 ? 3.5 : -3.5;
      if (std::abs(x) < 3.0) continue;
      const Eigen::Vector3d velocity(15.0 + 0.5 * id, 0.0, 0.0);
      Body& body = add_body(id, {x, y, kHeight_m}, velocity);
      body.number_of_centres = 8;
      for (int c = 1; c < 8; ++c) {
        scene.centres.push_back(
            {{x + stream.uniform(-2.0, 2.0), y + stream.uniform(-0.9, 0.9), kHeight_m}, velocity, {0, 0, 0}, 5.0});
      }
    }
  }
};

struct Row {
  float range, azimuth, elevation, rate, rcs;
  Provenance provenance;
  auto operator<=>(const Row&) const = default;
};

/// The detections of some scans that are not clutter, sorted.
std::vector<Row> rows(const Bench& bench, std::uint32_t cycles = 5) {
  std::vector<Row> rows;
  for (std::uint32_t cycle = 0; cycle < cycles; ++cycle) {
    const Measured m = measure(bench, cycle);
    for (std::size_t i = 0; i < m.count(); ++i) {
      if (m.truth[i].provenance == Provenance::kClutter) continue;
      rows.push_back({m.scan->range_m[i], m.scan->azimuth_rad[i], m.scan->elevation_rad[i], m.scan->range_rate_mps[i],
                      m.scan->rcs_dbsm[i], m.truth[i].provenance});
    }
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

TEST(Effects, TheSameSeedIsTheSameScanAndAnotherIsNot) {
  Road road;
  road.effects.clutter_per_scan = 3.0;
  const Measured a = measure(road, 4), b = measure(road, 4);
  ASSERT_EQ(a.count(), b.count());
  for (std::size_t i = 0; i < a.count(); ++i) ASSERT_EQ(a.scan->range_m[i], b.scan->range_m[i]);
  const auto first = rows(road);
  EXPECT_GT(first.size(), 100u);
  road.seed = 8;
  EXPECT_NE(first, rows(road));
}

TEST(Effects, AScanDependsOnNoScanBefore) {
  const Road road;
  RadarSensor sensor(road.config, road.effects, road.ego_body, road.seed);
  Measured m;
  for (std::uint32_t cycle = 0; cycle < 4; ++cycle) sensor.measure(road.scene, cycle, *m.scan, m.truth);
  const Measured alone = measure(road, 3);
  ASSERT_EQ(m.count(), alone.count());
  for (std::size_t i = 0; i < m.count(); ++i) ASSERT_EQ(m.scan->azimuth_rad[i], alone.scan->azimuth_rad[i]);
}

TEST(Effects, AddingOneChangesNoOther) {
  const Road road;
  const auto alone = rows(road);
  Road more = road;
  more.effects.clutter_per_scan = 4.0;
  more.effects.interference = {{0, 0.0, 10.0, 0.0, 20.0}};    // false detections only
  more.effects.step_changes = {{1, 5.0, {0.1, 0.0, 0.0}}};    // later than now
  more.effects.blockages = {{2, 0.0, 0.0, 30.0, -3.2, 3.2}};  // another radar
  more.effects.misalignment[2] = {0.1, 0.0, 0.0};
  EXPECT_EQ(alone, rows(more));
  EXPECT_GT(measure(more).of(Provenance::kClutter), 10u);
  // A new scatterer far from all others has its own draws.
  Road another = road;
  another.scene.scatterers.insert(another.scene.scatterers.begin(), {{60.0, 0.5, kHeight_m}, 30.0});
  const auto with = rows(another);
  EXPECT_EQ(with.size(), alone.size() + 5);
  EXPECT_TRUE(std::includes(with.begin(), with.end(), alone.begin(), alone.end()));
  // Without mirrors the direct echoes do not change, since cells of size 0 hold no target together with a ghost.
  Road fine = road;
  fine.effects.resolution = {0.0, 0.0, 0.0};
  const auto with_mirrors = rows(fine);
  fine.effects.multipath.max_bounces = 1;
  const auto direct = rows(fine);
  EXPECT_LT(direct.size(), with_mirrors.size());
  EXPECT_TRUE(std::includes(with_mirrors.begin(), with_mirrors.end(), direct.begin(), direct.end()));
}

TEST(Effects, ThereIsNoClutterInTheCellOfARealDetection) {
  Bench e;
  e.effects.clutter_per_scan = 20.0;
  e.scene.scatterers = {{{100.0, 0.0, kHeight_m}, 10.0}};
  ASSERT_GT(measure(e).of(Provenance::kClutter), 5u);
  // Azimuth cells of half the field of view; range and range-rate cells wider than the scene.
  e.effects.resolution = {300.0, 0.65, 200.0};
  std::size_t beyond = 0;
  for (std::uint32_t cycle = 0; cycle < 50; ++cycle) {
    const Measured m = measure(e, cycle);
    ASSERT_EQ(m.of(Provenance::kStationary), 1u);
    for (std::size_t i = 0; i < m.count(); ++i) {
      if (m.truth[i].provenance != Provenance::kClutter) continue;
      ASSERT_GE(std::abs(m.scan->azimuth_rad[i]), 0.65 - 1e-6);
      ++beyond;
    }
  }
  EXPECT_NEAR(static_cast<double>(beyond), 500.0, 80.0);
}

TEST(Effects, ClutterIsPoissonWithItsMean) {
  Bench e;
  e.effects.clutter_per_scan = 2.5;
  e.effects.noise = true;
  double sum = 0.0, squares = 0.0;
  constexpr std::uint32_t kScans = 3000;
  for (std::uint32_t cycle = 0; cycle < kScans; ++cycle) {
    const auto n = static_cast<double>(measure(e, cycle).of(Provenance::kClutter));
    sum += n;
    squares += n * n;
  }
  const double mean = sum / kScans;
  EXPECT_NEAR(mean, 2.5, 0.15);
  EXPECT_NEAR(squares / kScans - mean * mean, 2.5, 0.3);
}

TEST(Effects, InterferenceLastsItsTimeRaisesTheNoiseAndMakesFalseDetections) {
  Road road;
  road.effects.interference = {{1, 2.0, 1.0, 12.0, 40.0}};
  std::vector<std::size_t> real, clutter;
  for (const double t : {1.99, 2.0, 2.9, 3.0}) {
    road.scene.t_s = t;
    const Measured m = measure(road);
    clutter.push_back(m.of(Provenance::kClutter));
    real.push_back(m.count() - clutter.back());
  }
  EXPECT_EQ(clutter[0], 0u);
  EXPECT_GT(clutter[1], 20u);
  EXPECT_GT(clutter[2], 20u);
  EXPECT_EQ(clutter[3], 0u);
  EXPECT_LT(real[1], real[0]);
  EXPECT_EQ(real[3], real[0]);
  road.config.id = 2;  // another radar is not disturbed
  road.scene.t_s = 2.5;
  EXPECT_EQ(measure(road).of(Provenance::kClutter), 0u);
}

TEST(Effects, BlockageGrowsTakesDetectionsAwayAndIsStated) {
  Road road;
  road.effects.noise = false;
  road.effects.blockages = {{1, 10.0, 30.0, 20.0, -3.2, 3.2}};
  EXPECT_DOUBLE_EQ(radar::built_up_db(road.effects.blockages[0], 9.0), 0.0);
  EXPECT_DOUBLE_EQ(radar::built_up_db(road.effects.blockages[0], 20.0), 10.0);
  EXPECT_DOUBLE_EQ(radar::built_up_db(road.effects.blockages[0], 50.0), 20.0);
  const RadarSensor sensor(road.config, road.effects, road.ego_body, road.seed);
  std::vector<std::size_t> counts;
  for (const double t : {0.0, 15.0, 20.0, 30.0}) {
    road.scene.t_s = t;
    counts.push_back(rows(road).size());
  }
  EXPECT_TRUE(std::is_sorted(counts.rbegin(), counts.rend()));
  EXPECT_LT(counts[3], counts[0] / 2);
  EXPECT_EQ(sensor.condition(11.0), 0u);
  EXPECT_EQ(sensor.condition(15.0), source_condition::kPartlyBlocked);
  EXPECT_EQ(sensor.condition(30.0), source_condition::kBlocked);

  // On one side only.
  road.effects.blockages = {{1, 0.0, 0.0, 200.0, 0.0, 3.2}};
  const Measured half = measure(road);
  EXPECT_GT(half.count(), 10u);
  for (std::size_t i = 0; i < half.count(); ++i) EXPECT_LT(half.scan->azimuth_rad[i], 0.0F);
  EXPECT_EQ(RadarSensor(road.config, road.effects, road.ego_body, 1).condition(1.0), source_condition::kPartlyBlocked);
}

TEST(Effects, AMisalignedAndStepChangedRadarSeesTheWorldTurned) {
  Bench e;
  e.config.mounting_pose.yaw_rad = 0.4;
  e.effects.misalignment[1] = {0.03, -0.02, 0.05};
  e.effects.step_changes = {{1, 5.0, {-0.01, 0.04, 0.02}}, {2, 0.0, {1.0, 1.0, 1.0}}};
  const Eigen::Vector3d place(40.0, 12.0, 3.0);
  e.scene.scatterers = {{place, 0.0}};
  const Eigen::Vector3d truth = (place - Eigen::Vector3d(0.0, 0.0, kHeight_m)).normalized();
  for (const auto& [t, yaw, pitch, roll] : {std::array{4.99, 0.43, -0.02, 0.05}, {5.0, 0.42, 0.02, 0.07}}) {
    e.scene.t_s = t;
    const Measured m = measure(e);
    ASSERT_EQ(m.count(), 1u);
    const Eigen::Vector3d seen = geometry::sensor_to_vehicle(yaw, pitch, roll) *
                                 geometry::direction(m.scan->azimuth_rad[0], m.scan->elevation_rad[0]);
    EXPECT_LT((seen - truth).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace boresight::simulator
