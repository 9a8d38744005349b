// The yaw of each radar over time.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::report {

namespace {

/// The yaw estimate of one radar with its 3 σ band. All radars share one scale.
std::string render_yaw(const ReportInput& input, const TimeBase& time, const RadarSummary& radar, double limit_deg) {
  std::vector<Point> estimate;
  std::vector<Point> lower;
  std::vector<Point> upper;
  for (const Snapshot& snapshot : input.snapshots) {
    const RadarSnapshot* const seen = find_radar(snapshot, radar.last.id);
    if (seen == nullptr || !has_estimate(*seen)) continue;
    const double t_s = time.seconds(snapshot);
    const double yaw_deg = seen->yaw.value_rad * kDegreesPerRadian;
    const double three_sigma_deg = 3.0 * seen->yaw.std_rad * kDegreesPerRadian;
    estimate.push_back({t_s, yaw_deg});
    lower.push_back({t_s, yaw_deg - three_sigma_deg});
    upper.push_back({t_s, yaw_deg + three_sigma_deg});
  }
  Chart chart(520, 210, {.min = 0, .max = time.end_s(), .label = "time, s"},
              {.min = -limit_deg, .max = limit_deg, .label = "mounting error, °"});
  const double tolerance_deg = radar.last.yaw_tolerance_rad * kDegreesPerRadian;
  chart.horizontal(tolerance_deg, svg::kTolerance);
  chart.horizontal(-tolerance_deg, svg::kTolerance);
  chart.band(lower, upper, svg::kUncertainty);
  if (radar.true_yaw_rad) chart.horizontal(*radar.true_yaw_rad * kDegreesPerRadian, svg::kTruth);
  chart.line(estimate, svg::kEstimate);
  return fmt::format("<div><h3>{}</h3>{}</div>\n", escape(radar.last.name), chart.finish());
}

}  // namespace

std::string render_alignment(const ReportInput& input, const TimeBase& time, const Summary& summary) {
  double limit_deg = 1.0;
  for (const RadarSummary& radar : summary.radars) {
    limit_deg = std::max({limit_deg, 1.3 * radar.last.yaw_tolerance_rad * kDegreesPerRadian,
                          1.3 * std::abs(radar.last.yaw.value_rad) * kDegreesPerRadian,
                          1.3 * std::abs(radar.true_yaw_rad.value_or(0.0)) * kDegreesPerRadian});
  }
  std::string text = "<h2>Mounting error in yaw over time</h2>\n<p class=\"legend\">" +
                     svg::page_key(svg::area_sample(svg::kUncertainty) + svg::line_sample(svg::kEstimate)) +
                     "estimate ± 3 σ" + svg::page_key(svg::line_sample(svg::kTruth)) + "truth, where known" +
                     svg::page_key(svg::line_sample(svg::kTolerance)) + "tolerance</p>\n<div class=\"grid2\">\n";
  for (const RadarSummary& radar : summary.radars) text += render_yaw(input, time, radar, std::min(limit_deg, 20.0));
  return text + "</div>\n";
}

}  // namespace boresight::report
