// Changes of one radar and of all, from what single blocks say.
#include <random>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/windows/change_monitor.hpp"
#include "services/alignment_estimator/core/windows/common_watch.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::alignment::windows {
namespace {

/// Four radars whose blocks scatter; `scatter_deg` in yaw, twice that in pitch.
class Blocks {
 public:
  Blocks(unsigned seed, double scatter_deg) : random_(seed), scatter_rad_(scatter_deg * kRadiansPerDegree) {}
  [[nodiscard]] const std::vector<Deviation2>& next(const Eigen::Vector2d& all = Eigen::Vector2d::Zero()) {
    std::normal_distribution<double> normal(0.0, 1.0);
    for (std::size_t r = 0; r < values.size(); ++r) {
      const double pitch = 2.0 * normal(random_), yaw = normal(random_);
      values[r].value = all + scatter_rad_ * Eigen::Vector2d(pitch, yaw) + (r == turned ? turn : Eigen::Vector2d(0, 0));
      values[r].std = {0.05 * kRadiansPerDegree, 0.02 * kRadiansPerDegree};
      values[r].valid = true;
    }
    return values;
  }
  std::vector<Deviation2> values{4};
  std::size_t turned = 99;
  Eigen::Vector2d turn{0.0, 0.0};

 private:
  std::mt19937 random_;
  double scatter_rad_;
};

/// Number of blocks until a change is reported; 99: none. `verdicts` are those of the last block.
int blocks_to_change(ChangeMonitor& monitor, Blocks& blocks, std::vector<ChangeVerdict>& verdicts, int most,
                     const Eigen::Vector2d& all = Eigen::Vector2d::Zero()) {
  for (int i = 1; i <= most; ++i) {
    monitor.judge(blocks.next(all), verdicts);
    for (const ChangeVerdict& verdict : verdicts) {
      if (verdict.changed) return i;
    }
  }
  return 99;
}

TEST(ChangeMonitor, AStepOfOneRadarIsReportedForThatRadar) {
  for (const Eigen::Vector2d& turn :
       {Eigen::Vector2d(0.0, kRadiansPerDegree), Eigen::Vector2d(-2.0 * kRadiansPerDegree, 0.0)}) {
    ChangeMonitor monitor(4, {});
    Blocks blocks(1, 0.03);
    std::vector<ChangeVerdict> verdicts(4);
    EXPECT_EQ(blocks_to_change(monitor, blocks, verdicts, 100), 99);
    EXPECT_GT(monitor.windows(2), 50u);
    blocks.turned = 2;
    blocks.turn = turn;
    EXPECT_LE(blocks_to_change(monitor, blocks, verdicts, 20), 6);
    for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(verdicts[r].changed, r == 2) << r;
    EXPECT_LT((verdicts[2].turn_rad - turn).norm(), 0.15 * kRadiansPerDegree);
  }
}

TEST(ChangeMonitor, ANewSceneIsNoStep) {
  // On a mirroring road the elevations change with the scene; the std of pitch says so.
  for (const double estimate_deg : {0.0, 0.5}) {
    ChangeMonitor monitor(4, {});
    Blocks blocks(3, 0.03);
    for (Deviation2& value : blocks.values) value.estimate_std = {estimate_deg * kRadiansPerDegree, 0.0};
    std::vector<ChangeVerdict> verdicts(4);
    static_cast<void>(blocks_to_change(monitor, blocks, verdicts, 60));
    blocks.turned = 1;
    blocks.turn = {1.2 * kRadiansPerDegree, 0.0};
    const int after = blocks_to_change(monitor, blocks, verdicts, 30);
    if (estimate_deg > 0.0) {
      EXPECT_EQ(after, 99);
      EXPECT_FALSE(verdicts[1].suspect);
    } else {
      EXPECT_LE(after, 6);
    }
  }
}

TEST(ChangeMonitor, AStepIsSuspectBeforeItIsReported) {
  ChangeMonitor monitor(4, {});
  Blocks blocks(2, 0.03);
  std::vector<ChangeVerdict> verdicts(4);
  static_cast<void>(blocks_to_change(monitor, blocks, verdicts, 60));
  blocks.turned = 0;
  blocks.turn = {0.0, kRadiansPerDegree};
  monitor.judge(blocks.next(), verdicts);
  monitor.judge(blocks.next(), verdicts);
  EXPECT_TRUE(verdicts[0].suspect) << "it must not be learnt";
  EXPECT_FALSE(verdicts[0].changed);
  EXPECT_FALSE(verdicts[1].suspect);
}

TEST(ChangeMonitor, AStepOfAllRadarsIsNoChangeOfOne) {
  for (const Eigen::Vector2d& all :
       {Eigen::Vector2d(0.0, 1.0 * kRadiansPerDegree), Eigen::Vector2d(2.0 * kRadiansPerDegree, 0.0)}) {
    ChangeMonitor monitor(4, {});
    Blocks blocks(3, 0.03);
    std::vector<ChangeVerdict> verdicts(4);
    static_cast<void>(blocks_to_change(monitor, blocks, verdicts, 60));
    EXPECT_EQ(blocks_to_change(monitor, blocks, verdicts, 60, all), 99);
  }
}

TEST(ChangeMonitor, ASmallStepIsFollowedWithoutReport) {
  ChangeMonitor monitor(4, {});
  Blocks blocks(4, 0.03);
  std::vector<ChangeVerdict> verdicts(4);
  static_cast<void>(blocks_to_change(monitor, blocks, verdicts, 60));
  blocks.turned = 1;
  blocks.turn = {0.0, 0.3 * kRadiansPerDegree};
  EXPECT_EQ(blocks_to_change(monitor, blocks, verdicts, 60), 99);
}

TEST(ChangeMonitor, ScatterRaisesTheLimit) {
  // The same turn is reported by a quiet radar, and is none for one whose blocks scatter by half of it.
  for (const double scatter_deg : {0.03, 0.4}) {
    ChangeMonitor monitor(4, {});
    Blocks blocks(5, scatter_deg);
    std::vector<ChangeVerdict> verdicts(4);
    EXPECT_EQ(blocks_to_change(monitor, blocks, verdicts, 150), 99) << scatter_deg;
    blocks.turned = 3;
    blocks.turn = {0.0, 0.8 * kRadiansPerDegree};
    EXPECT_EQ(blocks_to_change(monitor, blocks, verdicts, 15) < 99, scatter_deg < 0.1) << scatter_deg;
  }
}

TEST(ChangeMonitor, ABurstIsNoChange) {
  ChangeMonitor monitor(4, {});
  Blocks blocks(6, 0.03);
  std::vector<ChangeVerdict> verdicts(4);
  static_cast<void>(blocks_to_change(monitor, blocks, verdicts, 60));
  blocks.turned = 1;
  blocks.turn = {0.0, 1.5 * kRadiansPerDegree};
  EXPECT_EQ(blocks_to_change(monitor, blocks, verdicts, 2), 99);
  blocks.turned = 99;
  EXPECT_EQ(blocks_to_change(monitor, blocks, verdicts, 60), 99);
}

TEST(ChangeMonitor, BlocksWithoutAMeasurementDoNotCount) {
  ChangeMonitor monitor(4, {});
  std::vector<Deviation2> nothing(4);
  std::vector<ChangeVerdict> verdicts(4);
  for (Deviation2& d : nothing) d.value = {1.0, 1.0};
  for (int i = 0; i < 30; ++i) monitor.judge(nothing, verdicts);
  for (const ChangeVerdict& verdict : verdicts) EXPECT_FALSE(verdict.changed || verdict.suspect);
  EXPECT_EQ(monitor.windows(0), 0u);
}

CommonConfig pitch_watch() {
  return ChangeConfig{}.load;
}

TEST(CommonWatch, AStepIsFoundWithItsSizeAndTime) {
  for (const double size_deg : {0.5, -0.8}) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0.0, 0.1 * kRadiansPerDegree);
    CommonWatch watch(pitch_watch());
    for (int i = 0; i < 60; ++i) EXPECT_FALSE(watch.add(normal(random)));
    int after = 0;
    std::optional<CommonStep> step;
    while (!step && after < 30) {
      ++after;
      step = watch.add(size_deg * kRadiansPerDegree + normal(random));
    }
    ASSERT_TRUE(step) << size_deg;
    EXPECT_LE(after, 12);
    EXPECT_NEAR(step->size, size_deg * kRadiansPerDegree, 4.0 * step->std);
    EXPECT_NEAR(static_cast<double>(step->blocks_ago), after, 1.0);
    EXPECT_EQ(watch.size(), step->blocks_ago) << "blocks before the step are void";
  }
}

TEST(CommonWatch, ScatterASlowFluctuationAndASmallStepAreNone) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    CommonWatch scatter(pitch_watch()), slow(pitch_watch()), small(pitch_watch());
    double fluctuation = 0.0;
    for (int i = 0; i < 200; ++i) {
      EXPECT_FALSE(scatter.add(0.15 * kRadiansPerDegree * normal(random))) << seed;
      fluctuation = std::exp(-1.0 / 20.0) * fluctuation + 0.1 * kRadiansPerDegree * std::sqrt(0.095) * normal(random);
      EXPECT_FALSE(slow.add(fluctuation)) << seed;
      EXPECT_FALSE(small.add((i < 100 ? 0.0 : 0.15 * kRadiansPerDegree) + 0.03 * kRadiansPerDegree * normal(random)))
          << seed;
    }
  }
}

TEST(CommonMean, NeedsTwoRadarsAndWeighsThem) {
  EXPECT_FALSE(common_mean({1.0, 2.0}, {0.1, 0.0}, 0.1));
  EXPECT_NEAR(common_mean({1.0, 3.0}, {0.1, 0.1}, 0.1).value(), 2.0, 1e-12);
  EXPECT_NEAR(common_mean({1.0, 3.0, 99.0}, {0.1, 10.0, 0.0}, 1e-3).value(), 1.0, 1e-3);
}

}  // namespace
}  // namespace boresight::alignment::windows
