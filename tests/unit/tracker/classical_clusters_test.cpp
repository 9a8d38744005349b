// Weighted clusters of one scan's detections.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "services/tracker/core/classical/clusters.hpp"

namespace boresight::tracking::classical {
namespace {

Measurement<double> detection(double x_m, double y_m, double range_rate_mps, double moving = 1.0) {
  Measurement<double> z;
  z.position_m = {x_m, y_m};
  z.sight = {1.0, 0.0};
  z.range_rate_mps = range_rate_mps;
  z.moving = moving;
  return z;
}

class ClusterTest : public testing::Test {
 protected:
  std::size_t find(const std::vector<Measurement<double>>& list) {
    return clusters_.find(list, std::vector<std::int32_t>(list.size(), -1), parameters_);
  }
  Clusters clusters_{64};
  ClusterParameters parameters_;
};

TEST_F(ClusterTest, GapOfRangeRatesDividesDetectionsOfOnePlace) {
  ASSERT_EQ(find({detection(10, 0, 5.0), detection(10.5, 0, -5.0), detection(11, 0, 5.4), detection(10, 1, -5.3)}), 2u);
  EXPECT_DOUBLE_EQ(clusters_.cell(0).n, 2.0);
  EXPECT_NEAR(clusters_.cell(0).mean().x, 10.25, 1e-12);
  EXPECT_NEAR(clusters_.cell(1).mean().x, 10.5, 1e-12);
}

TEST_F(ClusterTest, SteadyChangeOfRangeRatesAlongALongObjectDividesNothing) {
  std::vector<Measurement<double>> list;
  for (int k = 0; k < 8; ++k) list.push_back(detection(10.0 + 2.0 * k, 3.0, 0.8 * k));
  EXPECT_EQ(find(list), 1u);
}

TEST_F(ClusterTest, DetectionsThatAreHardlyMovingMakeNoCluster) {
  EXPECT_EQ(find({detection(10, 0, 5.0, 0.04), detection(11, 0, 5.0, 0.04)}), 0u);
  EXPECT_EQ(find({detection(10, 0, 5.0, 0.04), detection(11, 0, 5.0, 0.07)}), 1u);
}

TEST_F(ClusterTest, DetectionOfATrackBelongsToNoCluster) {
  const std::vector<Measurement<double>> list = {detection(10, 0, 5.0), detection(11, 0, 5.0)};
  ASSERT_EQ(clusters_.find(list, std::vector<std::int32_t>{3, -1}, parameters_), 1u);
  ASSERT_EQ(clusters_.members(0).size(), 1u);
  EXPECT_EQ(clusters_.members(0)[0], 1u);
}

TEST_F(ClusterTest, OrderAndRotationOfTheScanChangeNothing) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-20.0, 20.0), rate(-3.0, 3.0);
  std::vector<Measurement<double>> list;
  for (int k = 0; k < 60; ++k) list.push_back(detection(place(random), place(random), rate(random)));
  const auto sets = [&](const std::vector<std::size_t>& original) {
    std::set<std::set<std::size_t>> all;
    for (std::size_t c = 0; c < find(list); ++c) {
      std::set<std::size_t> one;
      for (const std::size_t i : clusters_.members(c)) one.insert(original[i]);
      all.insert(one);
    }
    return all;
  };
  std::vector<std::size_t> original(list.size());
  for (std::size_t i = 0; i < original.size(); ++i) original[i] = i;
  const auto before = sets(original);
  std::reverse(list.begin(), list.end());
  std::reverse(original.begin(), original.end());
  for (auto& z : list) {
    z.position_m = {0.6 * z.position_m.x - 0.8 * z.position_m.y, 0.8 * z.position_m.x + 0.6 * z.position_m.y};
  }
  EXPECT_EQ(sets(original), before);
}

TEST_F(ClusterTest, EmptyScanHasNone) {
  EXPECT_EQ(find({}), 0u);
}

}  // namespace
}  // namespace boresight::tracking::classical
