// The cells of the published table, and bars with intervals.
#include "tests/benchmarks/ghosts/drives/judge/scene.hpp"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

namespace boresight::bench::ghosts_drives {
namespace {

TEST(Scene, PublishedRowsArePercentages) {
  for (const PublishedRow& row : kPublishedRows) {
    EXPECT_NEAR(std::accumulate(row.percent.begin(), row.percent.end(), 0.0), 100.0, 0.02) << row.count;
  }
}

TEST(Scene, RightCellsAreAtLeastAndWrongOnesAtMostThePublishedFigures) {
  const Limits right = cell_limits(Provenance::kMoving, Provenance::kMoving, 97.71);
  EXPECT_EQ(right.low, 97.71);
  EXPECT_EQ(right.high, std::numeric_limits<double>::infinity());
  const Limits wrong = cell_limits(Provenance::kClutter, Provenance::kGhostType2, 66.15);
  EXPECT_EQ(wrong.high, 66.15);
  EXPECT_EQ(wrong.low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(text_of(cell_limits(Provenance::kGhostType1, Provenance::kStationary, 0.0)), "—");
}

TEST(Scene, FiguresAreMediansOverTheDrivesThatHaveSuchDetections) {
  std::vector<judge::Confusion> drives(3);
  for (int i = 0; i < 3; ++i) drives[0].add(Provenance::kMoving, Provenance::kMoving, false);
  drives[0].add(Provenance::kMoving, Provenance::kClutter, false);
  drives[0].add(Provenance::kMoving, Provenance::kUnknown, true);
  drives[1].add(Provenance::kMoving, Provenance::kMoving, false);
  const MedianFigure right = percent_of_cell(drives, Provenance::kMoving, Provenance::kMoving);
  EXPECT_DOUBLE_EQ(right.median, 87.5) << "of 75 and 100; the third drive has none";
  EXPECT_EQ(right.interval.low, 75.0);
  EXPECT_EQ(right.interval.high, 100.0);
  EXPECT_EQ(count_of(drives, Provenance::kMoving).median, 1.0) << "of 5 with the rejected one, 1 and 0";
}

TEST(Scene, BothMethodsSeeTheSameDetections) {
  ghosts::Config published;
  published.method = ghosts::MethodName::kPublished;
  const judge::Confusion a = run_scene(101, 1.0, {}), b = run_scene(101, 1.0, published);
  for (const PublishedRow& row : kPublishedRows) {
    EXPECT_GT(a.count(row.truth), 0u);
    EXPECT_EQ(a.count(row.truth), b.count(row.truth));
  }
}

TEST(Bars, AMissInsideTheIntervalIsMet) {
  Findings findings;
  EXPECT_EQ(findings.judge({0.5, 0.7}, at_most(0.6)), "met");
  EXPECT_EQ(findings.judge({0.61, 0.7}, at_most(0.6)), "missed");
  EXPECT_EQ(findings.judge({0.5, 0.7}, at_least(0.6)), "met");
  EXPECT_EQ(findings.judge({0.5, 0.59}, at_least(0.6)), "missed");
  EXPECT_EQ(findings.judge({3.0, 4.0}, {1.0, 2.0}), "missed");
  EXPECT_EQ(findings.judge({0.0, 1.0}, {}), "—");
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(findings.judge({none, none}, at_least(0.85)), "no data");
  EXPECT_EQ(findings.met(), 2u);
  EXPECT_EQ(findings.missed(), 3u);
}

TEST(Bars, LimitsAreWrittenInFull) {
  EXPECT_EQ(text_of(at_least(97.71)), "≥ 97.71");
  EXPECT_EQ(text_of(at_most(0.6)), "≤ 0.6");
  EXPECT_EQ(text_of(Limits{69.35, 79.35}), "69.35–79.35");
}

}  // namespace
}  // namespace boresight::bench::ghosts_drives
