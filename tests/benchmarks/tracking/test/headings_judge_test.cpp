// Errors of headings against their deviations.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/benchmarks/tracking/headings/judge/heading_judge.hpp"

namespace boresight::bench::tracking {
namespace {

TEST(HeadingJudge, MeansAreOverAllHeadingsAndAnglesWrap) {
  HeadingJudge judge;
  judge.add(1, HeadingSource::kFused, {std::numbers::pi - 0.01, 0.0004}, -std::numbers::pi + 0.01);
  judge.add(1, HeadingSource::kFused, {0.5, 0.01}, 0.6);
  judge.add(2, HeadingSource::kFused, {0.0, 0.01}, 0.0);
  const auto figures = judge.figures(HeadingSource::kFused);
  EXPECT_EQ(figures.objects, 2u);
  EXPECT_NEAR(figures.rms_rad, std::sqrt((0.0004 + 0.01) / 3.0), 1e-9);
  EXPECT_NEAR(figures.nees, (1.0 + 1.0) / 3.0, 1e-9);
}

TEST(HeadingJudge, SourceWithoutHeadingsHasNoFigure) {
  HeadingJudge judge;
  judge.add(1, HeadingSource::kCourse, {0.0, 0.01}, 0.1);
  EXPECT_TRUE(std::isnan(judge.figures(HeadingSource::kLine).nees));
  EXPECT_EQ(judge.figures(HeadingSource::kLine).objects, 0u);
}

TEST(HeadingJudge, ObjectsOfAnotherDriveAreOthers) {
  HeadingJudge first, second;
  first.add(1, HeadingSource::kFused, {0.1, 0.01}, 0.0);
  first.end_drive();
  first.add(1, HeadingSource::kFused, {0.1, 0.01}, 0.0);
  second.add(1, HeadingSource::kFused, {0.1, 0.01}, 0.0);
  first.append(second);
  EXPECT_EQ(first.figures(HeadingSource::kFused).objects, 3u);
}

}  // namespace
}  // namespace boresight::bench::tracking
