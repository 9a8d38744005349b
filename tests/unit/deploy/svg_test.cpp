// Charts and pictures.
#include <cmath>

#include <gmock/gmock.h>

#include "services/boresight/svg/document.hpp"

namespace boresight::svg {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Chart, TicksAreRoundAndCoverTheRange) {
  EXPECT_THAT(Chart::ticks(0.0, 60.0, 6), ::testing::ElementsAre(0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0));
  const auto ticks = Chart::ticks(-1.3, 1.3, 5);
  ASSERT_EQ(ticks.size(), 3U);
  EXPECT_DOUBLE_EQ(ticks[0], -1.0);
  EXPECT_DOUBLE_EQ(ticks[1], 0.0);
  EXPECT_THAT(Chart::ticks(1.0, 1.0, 5), ::testing::IsEmpty());
}

TEST(Chart, NumbersAtTheEdgeLieInThePicture) {
  const Chart chart(520, 250, {.min = 100.0, .max = 10000.0, .label = "x", .logarithmic = true}, {.label = "y"});
  const std::string text = chart.finish();
  EXPECT_THAT(text, ::testing::ContainsRegex("text-anchor=\"middle\"[^<]*>1000<"));
  EXPECT_THAT(text, ::testing::ContainsRegex("text-anchor=\"end\"[^<]*>10000<"));
}

TEST(Chart, SkipsPointsThatAreNotFinite) {
  Chart chart(100, 100, {.label = "x"}, {.label = "y"});
  chart.line({{0.0, 0.0}, {0.5, NAN}, {1.0, 1.0}}, kEstimate);
  chart.dot({INFINITY, 0.0}, 2.0, area_of(kInk));
  EXPECT_THAT(chart.finish(), Not(HasSubstr("nan")));
  EXPECT_THAT(chart.finish(), Not(HasSubstr("<circle")));
}

TEST(Document, NeedsNoStyleSheetOfAViewer) {
  Chart chart(390, 215, {.min = 0.0, .max = 60.0, .label = "time, s"}, {.min = -1.0, .max = 1.0, .label = "°"});
  chart.band({{0.0, -0.5}, {60.0, -0.1}}, {{0.0, 0.5}, {60.0, 0.1}}, kUncertainty);
  chart.line({{0.0, 0.0}, {60.0, 0.0}}, kEstimate);
  chart.vertical(30.0, kMark, "a < b");
  chart.symbol({10.0, 0.5}, Shape::kDiamond, 3.0, area_of(kRed), "one");
  Document document;
  document.title("yaw & pitch");
  document.legend_at(14.0, 38.0);
  document.legend_entry(line_sample(kEstimate), "estimate ± 2 σ");
  document.place(chart, 14.0, 60.0);
  const std::string text = document.finish();
  EXPECT_THAT(text, Not(HasSubstr("var(")));
  EXPECT_THAT(text, Not(HasSubstr("<style")));
  EXPECT_THAT(text, Not(HasSubstr("class=")));
  EXPECT_THAT(text, HasSubstr("<rect fill=\"#ffffff\" width=\"418\" height=\"289\"/>"));
  EXPECT_THAT(text, HasSubstr("fill=\"none\" stroke=\"#2563b8\""));
  EXPECT_THAT(text, HasSubstr("a &lt; b"));
  EXPECT_THAT(text, HasSubstr("yaw &amp; pitch"));
}

TEST(Document, LegendEntriesStandSideBySide) {
  Document document;
  document.legend_at(10.0, 20.0);
  document.legend_entry(line_sample(kEstimate), "σ");
  document.legend_entry(line_sample(kTruth), "truth");
  EXPECT_THAT(document.finish(), HasSubstr("<g transform=\"translate(10,20)\">"));
  EXPECT_THAT(document.finish(), HasSubstr("<g transform=\"translate(67,20)\">")) << "σ is one character of two bytes";
}

}  // namespace
}  // namespace boresight::svg
