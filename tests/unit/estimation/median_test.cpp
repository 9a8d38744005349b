// Median and median deviation against sorted values.
#include "services/common/estimation/median.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace boresight::estimation {
namespace {

TEST(Median, is_the_middle_of_the_sorted_values) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> value(-5, 5);
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<double> values(count), sorted;
    for (double& v : values) v = value(random);
    sorted = values;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(median(values), 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2])) << count;
  }
}

TEST(MadStd, is_that_of_a_normal_distribution_and_blind_to_outliers) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(3.0, 0.5);
  std::vector<double> values(20001);
  for (double& v : values) v = normal(random);
  std::vector<double> spoilt = values;
  for (std::size_t i = 0; i < 1000; ++i) spoilt[i] = 1e6;
  EXPECT_NEAR(mad_std(values, 3.0), 0.5, 0.015);
  EXPECT_NEAR(mad_std(spoilt, 3.0), 0.5, 0.06);
}

}  // namespace
}  // namespace boresight::estimation
