// Errors of the estimates, and whether they agree with the stated covariance.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::report {

/// Nothing where no truth is known.
std::string render_truth(const ReportInput& input, const TimeBase& time, const Summary& summary) {
  std::string rows, legend;
  double highest = 2.0;
  for (const Snapshot& snapshot : input.snapshots) {
    for (const RadarSnapshot& radar : snapshot.radars) {
      if (std::isfinite(radar.details.nees)) highest = std::max(highest, std::min(10.0, radar.details.nees));
    }
  }
  Chart chart(1080, 190, {.min = 0, .max = time.end_s(), .label = "time, s"},
              {.min = 0, .max = highest, .label = "NEES"});
  chart.horizontal(1.0, svg::kTruth);
  for (const RadarSummary& radar : summary.radars) {
    if (!radar.true_vehicle_rad || !has_estimate(radar.last)) continue;
    const monitor::AlignmentDetails& d = radar.last.details;
    const std::array<double, 3>& truth = *radar.true_vehicle_rad;
    rows += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td>"
        "<td class=n>{}</td></tr>\n",
        escape(radar.last.name), speed_scale_error_text(radar), error_text(d.yaw, truth[0]),
        error_text(d.pitch, truth[1]), error_text(d.roll, truth[2]), text::fixed(d.nees, 2),
        text::fixed(radar.mean_nees, 2));
    std::vector<Point> points;
    for (const Snapshot& snapshot : input.snapshots) {
      const RadarSnapshot* const seen = find_radar(snapshot, radar.last.id);
      if (seen != nullptr) points.push_back({time.seconds(snapshot), seen->details.nees});
    }
    const svg::Style style = svg::series(radar.last.id);
    chart.line(points, style);
    legend += svg::page_key(svg::line_sample(style)) + escape(radar.last.name);
  }
  if (rows.empty()) return rows;
  std::string text =
      "<h2>Estimation errors</h2>\n<p class=\"faint\">Estimate − truth at the end of the drive, about the vehicle's "
      "axes; in parentheses as a multiple of the stated σ. NEES (normalised estimation error squared) compares the "
      "errors of all observable parameters with their stated covariance P: eᵀP⁻¹e divided by the number of "
      "parameters. NEES is 1 on average if the stated σ is right, above 1 if σ is too small.</p>\n"
      "<table><tr><th>radar</th><th class=n>speed scale</th><th class=n>yaw</th><th class=n>pitch</th>"
      "<th class=n>roll</th><th class=n>NEES</th><th class=n>mean NEES of the drive</th></tr>\n" +
      rows + "</table>\n";
  if (summary.is_offline) return text + "<p>The tables of an offline run do not hold the NEES.</p>\n";
  return text + "<p class=\"legend\">" + legend + svg::page_key(svg::line_sample(svg::kTruth)) +
         "expected mean, 1</p>\n" + chart.finish();
}

}  // namespace boresight::report
