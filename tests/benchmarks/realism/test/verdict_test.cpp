// The rule of the verdicts, and the tables.
#include <set>

#include <gtest/gtest.h>

#include "tests/benchmarks/realism/rows/tables.hpp"

namespace boresight::bench::realism {
namespace {

Row row_of(Measured r, Measured n, Judged judged, int digits = 3, Scale scale = Scale::kRatio) {
  return {1, "row", "", digits, r, n, judged, [](const Statistics&) { return 1.0; }, scale};
}

TEST(Verdict, WithinAQuarterOfTheMeasuredValueIsMet) {
  const Row row = row_of(4.0, {}, Judged::kOwn);
  EXPECT_EQ(judge(row, Source::kRadarScenes, 4.99).outcome, Outcome::kMet);
  EXPECT_EQ(judge(row, Source::kRadarScenes, 3.01).outcome, Outcome::kMet);
  EXPECT_EQ(judge(row, Source::kRadarScenes, 5.1).outcome, Outcome::kMissed);
  EXPECT_EQ(judge(row, Source::kRadarScenes, 6.0).text(row.scale), "off by +50 %");
  EXPECT_EQ(judge(row, Source::kRadarScenes, 2.0).text(row.scale), "off by −50 %");
}

TEST(Verdict, InsideTheSpanOfTheTwoDrivesIsMet) {
  const Row row = row_of({7.5, 15.8}, {}, Judged::kOwn);
  EXPECT_EQ(judge(row, Source::kRadarScenes, 11.0).outcome, Outcome::kMet);
  EXPECT_EQ(judge(row, Source::kRadarScenes, 19.0).outcome, Outcome::kMet);
  EXPECT_EQ(judge(row, Source::kRadarScenes, 20.0).outcome, Outcome::kMissed);
}

TEST(Verdict, MeasuredValueIsKnownToHalfOfItsLastDigit) {
  EXPECT_EQ(judge(row_of({}, 0.0, Judged::kOwn, 0), Source::kNuScenes, 0.4).outcome, Outcome::kMet);
  EXPECT_EQ(judge(row_of({}, 0.0, Judged::kOwn, 0), Source::kNuScenes, 0.6).outcome, Outcome::kMissed);
}

TEST(Verdict, NegativeValuesHaveTheSameTolerance) {
  const Row row = row_of(-0.88, {}, Judged::kOwn);
  EXPECT_EQ(judge(row, Source::kRadarScenes, -1.05).outcome, Outcome::kMet);
  EXPECT_EQ(judge(row, Source::kRadarScenes, -1.2).outcome, Outcome::kMissed);
}

TEST(Verdict, LevelIsJudgedByItsPower) {
  const Row row = row_of(-11.0, {}, Judged::kOwn, 0, Scale::kLevel_db);
  EXPECT_EQ(judge(row, Source::kRadarScenes, -9.6).outcome, Outcome::kMet);  // 1 dB and half of the last digit
  EXPECT_EQ(judge(row, Source::kRadarScenes, -13.0).text(row.scale), "off by −2.0 dB");
}

TEST(Verdict, FigureWithoutDataIsNotMet) {
  const Row row = row_of(4.0, {}, Judged::kOwn);
  EXPECT_EQ(judge(row, Source::kRadarScenes, kNoFigure).outcome, Outcome::kNoData);
}

TEST(Verdict, ProfileIsJudgedByItsOwnRadarUnlessTheParameterIsShared) {
  const Row own = row_of(4.0, {}, Judged::kOwn), shared = row_of(4.0, {}, Judged::kShared);
  EXPECT_EQ(judge(own, Source::kNuScenes, 9.0).outcome, Outcome::kNotJudged);
  EXPECT_EQ(judge(shared, Source::kNuScenes, 9.0).outcome, Outcome::kMissed);
  EXPECT_EQ(judge(shared, Source::kNone, 9.0).outcome, Outcome::kNotJudged);
  EXPECT_EQ(judge(row_of(4.0, 5.0, Judged::kNo), Source::kRadarScenes, 9.0).outcome, Outcome::kNotJudged);
}

TEST(Verdict, IntervalThatReachesIntoTheToleranceIsMet) {
  const Row row = row_of(4.0, {}, Judged::kOwn);  // 3 … 5
  EXPECT_EQ(judge(row, Source::kRadarScenes, Spread(5.1, 4.9, 5.6)).outcome, Outcome::kMetByInterval);
  EXPECT_EQ(judge(row, Source::kRadarScenes, Spread(2.5, 2.0, 3.1)).outcome, Outcome::kMetByInterval);
  EXPECT_EQ(judge(row, Source::kRadarScenes, Spread(4.9, 4.7, 5.6)).outcome, Outcome::kMet);
  const Verdict missed = judge(row, Source::kRadarScenes, Spread(6.0, 5.1, 6.5));
  EXPECT_EQ(missed.outcome, Outcome::kMissed);
  EXPECT_EQ(missed.text(row.scale), "off by +50 %");
}

TEST(Spread, FewSeedsHaveTheirSpan) {
  const Spread spread = spread_of({3.0, 1.0, kNoFigure, 7.0});
  EXPECT_DOUBLE_EQ(spread.median, 3.0);
  EXPECT_DOUBLE_EQ(spread.low, 1.0);
  EXPECT_DOUBLE_EQ(spread.high, 7.0);
  EXPECT_TRUE(std::isnan(spread_of({kNoFigure, kNoFigure}).median));
}

TEST(Spread, ManySeedsHaveTheIntervalOfTheirMean) {
  const Spread spread = spread_of({1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0});
  EXPECT_DOUBLE_EQ(spread.median, 5.0);
  EXPECT_NEAR(spread.high - 5.0, 2.306 * std::sqrt(7.5) / 3.0, 0.005);
  EXPECT_NEAR(5.0 - spread.low, spread.high - 5.0, 1e-9);
  EXPECT_NEAR(student_t(5.0), 2.571, 0.005);
  EXPECT_NEAR(student_t(30.0), 2.042, 0.001);
}

TEST(Tables, EveryRowHasAMeasuredValueOrIsShownForComparison) {
  std::set<std::string> names;
  for (const Row& row : all_rows()) {
    EXPECT_TRUE(names.insert(std::to_string(row.section) + row.name).second) << row.name << " is there twice";
    EXPECT_TRUE(row.judged == Judged::kNo || row.radar_scenes.exists() || row.nuscenes.exists()) << row.name;
  }
}

TEST(Tables, RunWithoutDataIsNotMetAndIdealHasNoVerdict) {
  const std::vector<double> without_data = figures_of(Statistics{});
  const Tables tables = make_tables(
      {{"series_77ghz", Source::kRadarScenes, {without_data, without_data}}, {"ideal", Source::kNone, {without_data}}});
  ASSERT_EQ(tables.sections.size(), 6u);
  ASSERT_EQ(tables.tallies.size(), 1u);
  EXPECT_GT(tables.tallies[0].without_data, 100u);
  EXPECT_FALSE(tables.all_met());
  EXPECT_EQ(tables.sections[0].header,
            (std::vector<std::string>{"figure", "unit", "R", "N", "series_77ghz", "interval", "verdict", "ideal"}));
  for (const Table& table : tables.sections) {
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
  }
}

TEST(Tables, RowShowsMedianAndSpanOfItsSeeds) {
  const std::size_t rows = all_rows().size();
  const Tables tables =
      make_tables({{"series_77ghz",
                    Source::kRadarScenes,
                    {std::vector<double>(rows, 1.0), std::vector<double>(rows, 9.0), std::vector<double>(rows, 3.1)}}});
  const std::vector<std::string>& car_near = tables.sections[0].rows[0];  // measured mean 3.1
  EXPECT_EQ(car_near[4], "3.1");
  EXPECT_EQ(car_near[5], "1.0 … 9.0");
  EXPECT_EQ(car_near[6], "within");
  EXPECT_GT(tables.tallies[0].met_by_interval, 0u);
}

}  // namespace
}  // namespace boresight::bench::realism
