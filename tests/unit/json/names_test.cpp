// A radar name with blanks, quotes, a comma and letters beyond ASCII, in what people read: tables, screen, page.
#include <algorithm>
#include <sstream>
#include <string>

#include <gmock/gmock.h>

#include "services/boresight/align/table.hpp"
#include "services/boresight/monitor/render.hpp"
#include "services/boresight/report/html_report.hpp"
#include "services/common/text/columns.hpp"
#include "tests/unit/json/samples.hpp"

namespace boresight::json {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// 31 bytes, the longest that a vehicle file may hold.
const std::string kLongName = "<b>\"größte\" & längen</b>, ü";

/// The displayed column at which `word` begins in the line that contains `mark`.
std::size_t column_of(const std::string& text, const std::string& mark, const std::string& word) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(word);
    if (line.find(mark) != std::string::npos && at != std::string::npos) return text::columns(line.substr(0, at));
  }
  ADD_FAILURE() << "no line with " << mark << " and " << word << " in\n" << text;
  return 0;
}

monitor::RadarSnapshot radar_named(std::uint32_t id, const std::string& name) {
  monitor::RadarSnapshot radar;
  radar.id = id;
  radar.name = name;
  radar.scans = 10;
  radar.state = AlignmentState::kConverged;
  radar.yaw = {.value_rad = 0.0, .std_rad = 0.001, .observable = true};
  radar.labels.classified[1] = 5;
  radar.labels.scans = 1;
  return radar;
}

/// Two radars, one second apart.
std::vector<monitor::Snapshot> two_snapshots() {
  std::vector<monitor::Snapshot> snapshots(2);
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    snapshots[i].time_ns = static_cast<std::int64_t>(i + 1) * 1'000'000'000;
    snapshots[i].radars = {radar_named(1, "left"), radar_named(2, kLongName)};
  }
  return snapshots;
}

TEST(RadarNames, LongOnesWidenTheFirstColumnOfTheTableOfAlign) {
  ASSERT_EQ(kLongName.size(), 31u);
  align::Result result = testing::unknown_alignment();
  result.radars[0].name = "left";
  result.radars.push_back(result.radars[0]);
  result.radars[1].name = kLongName;
  const std::string table = align::to_table(result);
  const std::size_t yaw = column_of(table, "radar", "yaw");
  EXPECT_GT(yaw, text::columns("1 " + kLongName));
  EXPECT_EQ(column_of(table, "1 left", "not observable"), yaw);
  EXPECT_EQ(column_of(table, "1 " + kLongName, "not observable"), yaw);
  result.radars.pop_back();
  EXPECT_EQ(column_of(align::to_table(result), "radar", "yaw"), 20u) << "short names do not change the table";
}

TEST(RadarNames, LongOnesWidenTheFirstColumnOfTheMonitorsScreen) {
  const std::string screen = monitor::render_screen(two_snapshots()[1], {.width = 300});
  const std::size_t health = column_of(screen, "RADAR", "HEALTH");
  EXPECT_EQ(column_of(screen, "left ", "NOT_AVAILABLE"), health);
  EXPECT_EQ(column_of(screen, kLongName, "NOT_AVAILABLE"), health);
  EXPECT_THAT(monitor::render_line(two_snapshots()[1], 1.0), HasSubstr(kLongName));
}

TEST(RadarNames, LongOnesWidenTheFirstColumnOfTheSummary) {
  report::Truth truth;
  for (const std::uint32_t id : {1u, 2u}) {
    truth.yaw_rad[id] = 0.0;
    truth.vehicle_rad[id] = {0.0, 0.0, 0.0};
  }
  const std::string text = report::render_summary(report::summarise(two_snapshots(), truth));
  const std::size_t yaw = column_of(text, "  NEES", "yaw  ");
  EXPECT_GT(yaw, text::columns(kLongName));
  EXPECT_EQ(column_of(text, "  left ", "not observable"), yaw);
  EXPECT_EQ(column_of(text, "  " + kLongName, "not observable"), yaw);
  EXPECT_EQ(column_of(text, "  left ", " 0   +0.000 ± "), column_of(text, "  " + kLongName, " 0   +0.000 ± "));
}

TEST(RadarNames, AreEscapedEverywhereInTheReport) {
  report::ReportInput input;
  input.snapshots = two_snapshots();
  input.snapshots[1].radars[1].labels.classified[1] = 9;
  input.truth.yaw_rad[2] = 0.0;
  input.truth.vehicle_rad[2] = {0.0, 0.0, 0.0};
  const std::string page = report::render_html(input);
  const std::string escaped = "&lt;b&gt;&quot;größte&quot; &amp; längen&lt;/b&gt;, ü";
  EXPECT_THAT(page, Not(HasSubstr("<b>\"größte")));
  EXPECT_THAT(page, Not(HasSubstr("\"größte\"")));
  EXPECT_THAT(page, Not(HasSubstr("längen</b>")));
  for (const char* const section : {"<h2>Radars</h2>", "<h2>Alignment at the end</h2>", "<h2>Estimation errors</h2>",
                                    "<h2>Mounting error in yaw over time</h2>", "<h2>Health over time</h2>",
                                    "<h2>Ghost filter: classification of detections</h2>"}) {
    const std::size_t begin = page.find(section);
    ASSERT_NE(begin, std::string::npos) << section;
    EXPECT_NE(page.substr(begin, page.find("<h2>", begin + 1) - begin).find(escaped), std::string::npos) << section;
  }
}

TEST(RadarNames, OfDiagnosticsCannotBreakALine) {
  diagnostics::SensorHealth sensor;
  sensor.radar_name("front \"left\"\n\x1b[31m größte");
  EXPECT_THAT(diagnostics_text::to_line(sensor), HasSubstr("front \"left\"??[31m größte AVAILABLE NORMAL"));
  diagnostic_msgs::msg::dds_::DiagnosticArray_ array;
  diagnostic_msgs::msg::dds_::DiagnosticStatus_ status;
  status.level_(1);
  status.name_("radar/größte\n");
  status.message_("a\r\"b\"");
  array.status_().push_back(status);
  EXPECT_THAT(diagnostics_text::to_lines(array), HasSubstr("WARN  radar/größte?: a?\"b\""));
}

}  // namespace
}  // namespace boresight::json
