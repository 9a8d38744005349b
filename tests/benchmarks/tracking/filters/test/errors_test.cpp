#include "tests/benchmarks/tracking/filters/common/errors.hpp"

#include <gtest/gtest.h>

namespace boresight::bench::filters {
namespace {

TEST(FilterScenes, AreDrawnAlikeFromTheSameSeed) {
  const auto a = draw_run(scenes()[0], 5), b = draw_run(scenes()[0], 5), c = draw_run(scenes()[0], 6);
  ASSERT_EQ(a.measured.size(), kSteps);
  EXPECT_EQ(a.measured.back(), b.measured.back());
  EXPECT_NE(a.measured.back(), c.measured.back());
  // The truth has no chance in it: 80 m − 12 m/s · 9.95 s + 0.4 m/s² · (9.95 s)².
  EXPECT_NEAR(a.truth.back()(0), 80.0 - 12.0 * 9.95 + 0.4 * 9.95 * 9.95, 1e-9);
  EXPECT_EQ(a.truth.back(), c.truth.back());
}

TEST(FilterErrors, OfTheMeasurementsAreTheirNoise) {
  std::vector<RunErrors> runs;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) runs.push_back(errors_of_measurements(draw_run(scenes()[1], seed)));
  const Accuracy accuracy = accuracy_of(runs);
  EXPECT_NEAR(accuracy.rms(0), 1.0, 0.02);
  EXPECT_NEAR(accuracy.rms(1), 1.0, 0.02);
  EXPECT_NEAR(accuracy.rms(2), 0.05, 0.001);
  const Interval interval = rms_interval(runs, 0);
  EXPECT_LT(interval.low, accuracy.rms(0));
  EXPECT_GT(interval.high, accuracy.rms(0));
}

TEST(FilterErrors, OfAzimuthsAcrossTheSeamAreSmall) {
  const Eigen::Vector3d difference = squared_difference({1.0, 3.14, 0.0}, {1.0, -3.14, 0.0}).cwiseSqrt();
  EXPECT_NEAR(difference(1), (2.0 * M_PI - 6.28) * 180.0 / M_PI, 1e-9);
}

TEST(FilterErrors, AreThoseOfAllForms) {
  const auto run = draw_run(scenes()[0], 3);
  const Model<double> the_model = model<double>();
  std::size_t forms = 0;
  for_each_form<double>([&]<typename Filter>(std::size_t form, const Filter&) {
    EXPECT_EQ(form, forms++);
    const RunErrors errors = errors_of<double, Filter>(run, the_model);
    EXPECT_FALSE(errors.has_failed) << kFormNames[form];
    EXPECT_LT(std::sqrt(errors.squares(0)), 0.5) << kFormNames[form];
    EXPECT_GT(errors.nees, 0.0) << kFormNames[form];
  });
  EXPECT_EQ(forms, kForms);
}

}  // namespace
}  // namespace boresight::bench::filters
