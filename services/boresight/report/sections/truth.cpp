// Estimates beside the truth, and their covariance by it.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

/// How wrong the estimates are, and whether they say so; nothing where no truth is known.
std::string render_truth(const ReportInput& input, const TimeBase& time, const Summary& summary) {
  std::string rows, legend;
  double highest = 2.0;
  for (const Snapshot& snapshot : input.snapshots) {
    for (const RadarSnapshot& radar : snapshot.radars) {
      if (std::isfinite(radar.details.nees)) highest = std::max(highest, std::min(10.0, radar.details.nees));
    }
  }
  SvgChart chart(1080, 190, {.min = 0, .max = time.end_s(), .label = "time, s"},
                 {.min = 0, .max = highest, .label = "NEES"});
  chart.horizontal(1.0, "truth");
  for (const RadarSummary& radar : summary.radars) {
    if (!radar.true_vehicle_rad || !has_estimate(radar.last)) continue;
    const monitor::AlignmentDetails& d = radar.last.details;
    const std::array<double, 3>& truth = *radar.true_vehicle_rad;
    rows += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td>"
        "<td class=n>{}</td></tr>\n",
        escape(radar.last.name), speed_scale_off_by(radar), off_by(d.yaw, truth[0]), off_by(d.pitch, truth[1]),
        off_by(d.roll, truth[2]), known_number(d.nees, "", 2), known_number(radar.mean_nees, "", 2));
    std::vector<Point> points;
    for (const Snapshot& snapshot : input.snapshots) {
      const RadarSnapshot* const seen = find_radar(snapshot, radar.last.id);
      if (seen != nullptr) points.push_back({time.seconds(snapshot), seen->details.nees});
    }
    const std::uint32_t colour = radar.last.id % 5;
    chart.line(points, fmt::format("trail t{}", colour));
    legend += fmt::format("<i class=\"t{}\"></i>{}", colour, escape(radar.last.name));
  }
  if (rows.empty()) return rows;
  return "<h2>Against the truth</h2>\n<p class=\"faint\">Estimate − truth at the end, about the vehicle's axes. NEES: "
         "the errors of what is observable, squared and weighed by the inverse of the stated covariance, divided by "
         "their number; 1 on average where σ is honest.</p>\n"
         "<table><tr><th>radar</th><th class=n>speed scale</th><th class=n>yaw</th><th class=n>pitch</th>"
         "<th class=n>roll</th><th class=n>NEES</th><th class=n>mean over the drive</th></tr>\n" +
         rows + "</table>\n<p class=\"legend\">" + legend + "<i class=\"truth\"></i>honest</p>\n" + chart.finish();
}

}  // namespace boresight::report
