#include "services/boresight/report/html_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "services/boresight/monitor/render.hpp"
#include "services/boresight/report/svg_chart.hpp"

namespace boresight::report {

namespace {

using monitor::RadarSnapshot;
using monitor::Snapshot;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1c2430; --faint: #5c6675; --line: #d9dee6; --card: #f6f8fa;
  --blue: #2563b8; --band: #2563b826; --good: #2e8b57; --warn: #c98500; --bad: #c93a3a; --idle: #b9c1cc; --truth: #8a3fb0; }
@media (prefers-color-scheme: dark) { :root { --paper: #14181e; --ink: #e4e8ee; --faint: #9aa5b4; --line: #323a46;
  --card: #1b2129; --blue: #6ea8ff; --band: #6ea8ff2e; --good: #4cc38a; --warn: #e5a63a; --bad: #f26d6d; --idle: #4a5462;
  --truth: #c893ee; } }
body { background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; margin: 0 auto;
  max-width: 1080px; padding: 28px 24px 60px; }
h1 { font-size: 26px; margin: 0; } h2 { font-size: 18px; margin: 38px 0 6px; } p { margin: 4px 0 12px; }
.faint { color: var(--faint); }
.verdict { border-left: 5px solid var(--good); background: var(--card); padding: 10px 16px; margin: 18px 0; }
.verdict.bad { border-color: var(--bad); }
.verdict b { font-size: 17px; } .verdict ul { margin: 6px 0 0; padding-left: 20px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th { text-align: left; color: var(--faint); font-weight: 500; font-size: 13px; }
td, th { padding: 5px 12px 5px 0; border-bottom: 1px solid var(--line); }
td.n, th.n { text-align: right; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; } .warn { color: var(--warn); }
.grid2 { display: grid; grid-template-columns: 1fr 1fr; gap: 10px 22px; } .grid2 h3 { font-size: 14px; margin: 6px 0 0; }
@media (max-width: 760px) { .grid2 { grid-template-columns: 1fr; } }
.chart { width: 100%; height: auto; display: block; }
.chart text { fill: var(--faint); font-size: 11px; } .chart text.name { fill: var(--ink); font-size: 12px; }
.chart .grid { stroke: var(--line); stroke-width: 1; } .chart .frame { fill: none; stroke: var(--line); }
.chart .estimate { stroke: var(--blue); stroke-width: 2; } .chart .sigma { fill: var(--band); }
.chart .truth { stroke: var(--truth); stroke-width: 1.5; stroke-dasharray: 6 4; }
.chart .limit { stroke: var(--bad); stroke-width: 1; stroke-dasharray: 2 4; }
.chart .mark { stroke: var(--faint); stroke-width: 1; stroke-dasharray: 4 3; }
.chart .g { fill: var(--good); } .chart .w { fill: var(--warn); } .chart .b { fill: var(--bad); } .chart .i { fill: var(--idle); }
.chart .bar { fill: var(--blue); } .chart .car { fill: var(--ink); } .chart .fov { fill: var(--band); stroke: none; }
.chart .trail { stroke-width: 1.6; opacity: 0.75; } .chart .t0 { stroke: var(--blue); } .chart .t1 { stroke: var(--good); }
.chart .t2 { stroke: var(--warn); } .chart .t3 { stroke: var(--truth); } .chart .t4 { stroke: var(--bad); }
.chart .head { fill: var(--ink); }
.legend { color: var(--faint); font-size: 13px; } .legend i { display: inline-block; width: 22px; height: 0; margin: 0 5px 4px 14px;
  border-top: 2px solid var(--blue); vertical-align: middle; } .legend i.truth { border-top: 2px dashed var(--truth); }
.legend i.t1 { border-color: var(--good); }
.legend i.t2 { border-color: var(--warn); } .legend i.t3 { border-color: var(--truth); } .legend i.t4 { border-color: var(--bad); }
.legend i.limit { border-top: 2px dotted var(--bad); } .legend i.box { height: 10px; border: 0; }
pre { background: var(--card); padding: 12px 14px; overflow-x: auto; font-size: 12.5px; line-height: 1.45; }
)";

/// Seconds since the first snapshot with a scan.
class TimeBase {
 public:
  explicit TimeBase(const std::vector<Snapshot>& snapshots) {
    for (const Snapshot& snapshot : snapshots) {
      if (begin_ns_ == 0) begin_ns_ = snapshot.time_ns;
      const bool any = std::any_of(snapshot.radars.begin(), snapshot.radars.end(), [](auto& r) { return r.scans > 0; });
      if (!any) continue;
      begin_ns_ = snapshot.time_ns;
      break;
    }
    if (!snapshots.empty()) end_s_ = std::max(1.0, seconds(snapshots.back()));
  }
  [[nodiscard]] double seconds(const Snapshot& s) const { return static_cast<double>(s.time_ns - begin_ns_) * 1e-9; }
  [[nodiscard]] double end_s() const { return end_s_; }

 private:
  std::int64_t begin_ns_ = 0;
  double end_s_ = 1.0;
};

const RadarSnapshot* find_radar(const Snapshot& snapshot, std::uint32_t id) {
  for (const RadarSnapshot& radar : snapshot.radars) {
    if (radar.id == id) return &radar;
  }
  return nullptr;
}

std::string render_verdict(const ReportInput& input, const Summary& summary) {
  std::string text = fmt::format("<div class=\"verdict{}\"><b>{}</b><ul>\n", summary.all_passed() ? "" : " bad",
                                 summary.all_passed() ? "Everything worked." : "Not everything worked.");
  for (const Check& check : summary.checks) {
    text += fmt::format("<li><span class=\"{}\">{}</span> {}</li>\n", check.passed ? "good" : "bad",
                        check.passed ? "✓" : "✗", escape(check.what));
  }
  text += "</ul></div>\n";
  if (!input.truth.known()) text += "<p class=\"faint\">No truth is known for this drive.</p>\n";
  return text;
}

std::string known_angle(const monitor::AngleEstimate& angle) {
  if (!angle.observable) return "<span class=\"faint\">not observable</span>";
  return fmt::format("{:+.2f}° ± {:.2f}°", angle.value_rad * kDegrees, angle.std_rad * kDegrees);
}

std::string known_number(double value, const char* unit, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}{}", value, digits, unit) : "–";
}

/// About the vehicle's axes, with the key figures.
std::string render_details(const Summary& summary) {
  std::string text =
      "<h2>Alignment at the end</h2>\n<p class=\"faint\">Turns about the vehicle's axes. Time of driving until the "
      "estimate stayed within 5 % of its way.</p>\n"
      "<table><tr><th>radar</th><th class=n>yaw ± σ</th><th class=n>pitch ± σ</th><th class=n>roll ± σ</th>"
      "<th class=n>95 % of yaw</th><th class=n>of pitch</th><th class=n>yaw drift/min</th><th class=n>residual, "
      "m/s</th><th class=n>knocks</th></tr>\n";
  for (const RadarSummary& radar : summary.radars) {
    const monitor::AlignmentDetails& d = radar.last.details;
    const bool known = yaw_text(radar.last) != "-";
    const auto angle = [known](const monitor::AngleEstimate& a) { return known ? known_angle(a) : "–"; };
    text += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td>"
        "<td class=n>{}</td><td class=n>{}</td><td class=n>{}</td></tr>\n",
        escape(radar.last.name), angle(d.yaw), angle(d.pitch), angle(d.roll),
        known_number(d.yaw_seconds_to_95_percent, " s", 1), known_number(d.pitch_seconds_to_95_percent, " s", 1),
        known_number(d.yaw_drift_radpmin * kDegrees, "°", 3), known_number(d.residual_rmse_mps, "", 3), d.knocks);
  }
  text += "</table>\n";
  for (const RadarSummary& radar : summary.radars) {
    if (yaw_text(radar.last) == "-") continue;
    const monitor::AngleEstimate &bias = radar.last.details.yaw_rate_bias, &slip = radar.last.details.slip;
    text += fmt::format(
        "<p>Of the vehicle: yaw-rate bias {}, slip coefficient {}.</p>\n",
        bias.observable ? fmt::format("{:+.3f} ± {:.3f} °/s", bias.value_rad * kDegrees, bias.std_rad * kDegrees)
                        : "not observable",
        slip.observable ? fmt::format("{:.4f} ± {:.4f} rad per m/s²", slip.value_rad, slip.std_rad) : "not observable");
    break;
  }
  return text;
}

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

std::string render_table(const Summary& summary) {
  std::string text =
      "<h2>Radars</h2>\n<table><tr><th>radar</th><th class=n>scans</th><th class=n>lost</th><th class=n>yaw ± σ</th>"
      "<th class=n>truth</th><th class=n>error</th><th class=n>speed scale ± σ</th><th>verdict</th></tr>\n";
  for (const RadarSummary& radar : summary.radars) {
    const RadarSnapshot& last = radar.last;
    const bool known = yaw_text(last) != "-";
    std::string error = "–";
    if (known && radar.true_yaw_rad) {
      error = fmt::format("{:+.2f}°", (last.yaw.value_rad - *radar.true_yaw_rad) * kDegrees);
    }
    text += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td>"
        "<td class=n>{}</td><td class=\"{}\">{}</td></tr>\n",
        escape(last.name), last.scans, last.lost, yaw_text(last),
        radar.true_yaw_rad ? fmt::format("{:+.2f}°", *radar.true_yaw_rad * kDegrees) : "–", error,
        known ? fmt::format("{:.4f} ± {:.4f}", last.speed_scale, last.speed_scale_std) : "–",
        last.data_qualifier == DataQualifier::kAvailable ? "good" : "bad",
        radar.misaligned ? "MISALIGNED" : escape(monitor::verdict(last)));
  }
  return text + "</table>\n";
}

/// The yaw estimate of one radar with its 3σ band, on a scale that all radars share.
std::string render_yaw(const ReportInput& input, const TimeBase& time, const RadarSummary& radar, double limit_deg) {
  std::vector<Point> estimate;
  std::vector<Point> lower;
  std::vector<Point> upper;
  for (const Snapshot& snapshot : input.snapshots) {
    const RadarSnapshot* const seen = find_radar(snapshot, radar.last.id);
    if (seen == nullptr || yaw_text(*seen) == "-") continue;
    const double t_s = time.seconds(snapshot);
    const double yaw_deg = seen->yaw.value_rad * kDegrees;
    const double three_sigma_deg = 3.0 * seen->yaw.std_rad * kDegrees;
    estimate.push_back({t_s, yaw_deg});
    lower.push_back({t_s, yaw_deg - three_sigma_deg});
    upper.push_back({t_s, yaw_deg + three_sigma_deg});
  }
  SvgChart chart(520, 210, {.min = 0, .max = time.end_s(), .label = "time, s"},
                 {.min = -limit_deg, .max = limit_deg, .label = "yaw error, °"});
  const double tolerance_deg = radar.last.yaw_tolerance_rad * kDegrees;
  chart.horizontal(tolerance_deg, "limit");
  chart.horizontal(-tolerance_deg, "limit");
  chart.band(lower, upper, "sigma");
  if (radar.true_yaw_rad) chart.horizontal(*radar.true_yaw_rad * kDegrees, "truth");
  chart.line(estimate, "estimate");
  return fmt::format("<div><h3>{}</h3>{}</div>\n", escape(radar.last.name), chart.finish());
}

std::string render_alignment(const ReportInput& input, const TimeBase& time, const Summary& summary) {
  double limit_deg = 1.0;
  for (const RadarSummary& radar : summary.radars) {
    limit_deg = std::max({limit_deg, 1.3 * radar.last.yaw_tolerance_rad * kDegrees,
                          1.3 * std::abs(radar.last.yaw.value_rad) * kDegrees,
                          1.3 * std::abs(radar.true_yaw_rad.value_or(0.0)) * kDegrees});
  }
  std::string text =
      "<h2>Mounting error: yaw</h2>\n<p class=\"legend\"><i></i>estimate, with its 3σ band<i "
      "class=\"truth\"></i>truth, "
      "where known<i class=\"limit\"></i>tolerance</p>\n<div class=\"grid2\">\n";
  for (const RadarSummary& radar : summary.radars) text += render_yaw(input, time, radar, std::min(limit_deg, 20.0));
  return text + "</div>\n";
}

const char* css_of(const RadarSnapshot& radar) {
  if (radar.data_qualifier == DataQualifier::kAvailable) return "g";
  if (radar.extended_qualifier == ExtendedQualifier::kInitialising) return "i";
  return radar.data_qualifier == DataQualifier::kAvailableReduced ? "w" : "b";
}

const char* css_of(ServiceCondition condition) {
  switch (condition) {
    case ServiceCondition::kAlive:
      return "g";
    case ServiceCondition::kDegraded:
    case ServiceCondition::kRestarted:
      return "w";
    case ServiceCondition::kSilent:
      return "b";
    case ServiceCondition::kUnknown:
      break;
  }
  return "i";
}

/// One row of a timeline: stretches of equal state.
struct Stretch {
  double from_s;
  double to_s;
  std::string css;
  std::string state;
};

void draw_rows(SvgChart& chart, const std::vector<std::pair<std::string, std::vector<Stretch>>>& rows) {
  double y = static_cast<double>(rows.size());
  for (const auto& [name, stretches] : rows) {
    y -= 1.0;
    for (const Stretch& s : stretches) {
      chart.rectangle({s.from_s, y + 0.12}, {s.to_s, y + 0.6}, s.css,
                      fmt::format("{}: {} ({:.1f} to {:.1f} s)", name, s.state, s.from_s, s.to_s));
    }
    chart.text({0.0, y + 0.68}, " " + name, "name");
  }
}

std::string render_health(const ReportInput& input, const TimeBase& time, const Summary& summary) {
  std::vector<std::pair<std::string, std::vector<Stretch>>> rows;
  const auto extend = [&time, &rows](std::size_t row, const Snapshot& s, const char* css, std::string state) {
    const double t_s = std::max(0.0, time.seconds(s));
    auto& stretches = rows[row].second;
    if (!stretches.empty()) stretches.back().to_s = t_s;
    if (stretches.empty() || stretches.back().state != state) stretches.push_back({t_s, t_s, css, std::move(state)});
  };
  for (const RadarSummary& radar : summary.radars) rows.emplace_back(radar.last.name, std::vector<Stretch>());
  for (const auto& service : summary.services)
    rows.emplace_back(catalogue::name_of(service.service), std::vector<Stretch>());
  for (const Snapshot& snapshot : input.snapshots) {
    for (std::size_t i = 0; i < summary.radars.size(); ++i) {
      const RadarSnapshot* const seen = find_radar(snapshot, summary.radars[i].last.id);
      if (seen != nullptr) extend(i, snapshot, css_of(*seen), monitor::verdict(*seen));
    }
    for (std::size_t i = 0; i < std::min(summary.services.size(), snapshot.services.size()); ++i) {
      const ServiceCondition condition = snapshot.services[i].condition;
      extend(summary.radars.size() + i, snapshot, css_of(condition), std::string(name_of(condition)));
    }
  }
  const auto count = static_cast<double>(rows.size());
  SvgChart chart(1080, 46 + 34 * count, {.min = 0, .max = time.end_s(), .label = "time, s"},
                 {.min = 0, .max = count, .label = ""});
  draw_rows(chart, rows);
  return "<h2>Health</h2>\n<p class=\"legend\"><i class=\"box\" style=\"background:var(--good)\"></i>available, alive"
         "<i class=\"box\" style=\"background:var(--warn)\"></i>reduced, degraded"
         "<i class=\"box\" style=\"background:var(--bad)\"></i>not available, silent"
         "<i class=\"box\" style=\"background:var(--idle)\"></i>not yet judged</p>\n" +
         chart.finish();
}

/// Everything in the vehicle frame seen from above: x forward is up, y left is left.
std::string render_tracks(const ReportInput& input) {
  std::map<std::uint32_t, std::vector<Point>> trails;
  double ahead_m = 40.0;
  double aside_m = 15.0;
  for (const Snapshot& snapshot : input.snapshots) {
    for (const auto& track : snapshot.tracks) {
      if (!track.confirmed || !std::isfinite(track.x_m) || !std::isfinite(track.y_m)) continue;
      trails[track.id].push_back({track.x_m, track.y_m});
      ahead_m = std::max(ahead_m, std::min(120.0, std::abs(track.x_m) + 5.0));
      aside_m = std::max(aside_m, std::min(40.0, std::abs(track.y_m) + 3.0));
    }
  }
  // The same scale along both axes; the margins of the chart are 64 px across and 46 px down.
  const double px_per_m = (1080.0 - 64.0) / (2.0 * ahead_m);
  SvgChart chart(1080, 46.0 + 2.0 * aside_m * px_per_m, {.min = -ahead_m, .max = ahead_m, .label = "ahead, m"},
                 {.min = -aside_m, .max = aside_m, .label = "left, m"});
  for (const RadarConfig& radar : input.vehicle.radars) {
    std::vector<Point> sector = {{radar.mounting_pose.position_m[0], radar.mounting_pose.position_m[1]}};
    for (int i = 0; i <= 12; ++i) {
      const double azimuth_rad =
          radar.field_of_view.azimuth_min_rad +
          (radar.field_of_view.azimuth_max_rad - radar.field_of_view.azimuth_min_rad) * i / 12.0 +
          radar.mounting_pose.yaw_rad;
      constexpr double kDrawn_m = 12.0;  // a hint at where each radar looks, not its reach
      sector.push_back(
          {sector[0].x + kDrawn_m * std::cos(azimuth_rad), sector[0].y + kDrawn_m * std::sin(azimuth_rad)});
    }
    chart.band({}, sector, "fov");
  }
  chart.rectangle({-1.0, -0.9}, {3.7, 0.9}, "car", "the vehicle");
  for (const auto& [id, points] : trails) {
    if (points.size() < 2) continue;
    chart.line(points, fmt::format("trail t{}", id % 5));
    chart.dot(points.back(), 2.5, "head", fmt::format("#{}", id));
  }
  return fmt::format(
             "<h2>Tracks</h2>\n<p class=\"faint\">The ways of {} confirmed objects relative to the vehicle, seen from "
             "above; the dot is where each was last.</p>\n",
             trails.size()) +
         chart.finish();
}

std::string render_latencies(const Summary& summary) {
  std::string text =
      "<h2>Latency</h2>\n<div class=\"grid2\"><div>\n<table><tr><th>stage</th><th class=n>p50, µs</th>"
      "<th class=n>p99, µs</th><th class=n>max, µs</th></tr>\n";
  for (std::size_t i = 0; i < monitor::kNumberOfLatencies; ++i) {
    const LatencyHistogram& h = summary.latencies[i];
    text += fmt::format("<tr><td>{}</td><td class=n>{:.0f}</td><td class=n>{:.0f}</td><td class=n>{:.0f}</td></tr>\n",
                        monitor::kLatencyNames[i], h.percentile_us(0.5), h.percentile_us(0.99), h.max_us());
  }
  text +=
      "</table>\n<p class=\"faint\">A stage is from taking its input to publishing its output; the total is from the "
      "reception of the scan's last frame to the published track list, with all waiting in between.</p></div><div>\n";
  const LatencyHistogram& total = summary.latencies.back();
  std::size_t first = LatencyHistogram::kBuckets;
  std::size_t last = 0;
  std::uint64_t highest = 1;
  for (std::size_t i = 0; i < LatencyHistogram::kBuckets; ++i) {
    if (total.counts()[i] == 0) continue;
    first = std::min(first, i);
    last = i;
    highest = std::max(highest, total.counts()[i]);
  }
  if (first > last) return text + "<p>No scan reached the tracker.</p></div></div>\n";
  SvgChart chart(520, 250,
                 {.min = LatencyHistogram::edge_us(first > 2 ? first - 2 : 0),
                  .max = LatencyHistogram::edge_us(last + 3),
                  .label = "reception to track list, µs",
                  .logarithmic = true},
                 {.min = 0, .max = 1.15 * static_cast<double>(highest), .label = "scans"});
  for (std::size_t i = first; i <= last; ++i) {
    chart.rectangle({LatencyHistogram::edge_us(i), 0},
                    {LatencyHistogram::edge_us(i + 1), static_cast<double>(total.counts()[i])}, "bar",
                    fmt::format("{:.0f} to {:.0f} µs: {}", LatencyHistogram::edge_us(i),
                                LatencyHistogram::edge_us(i + 1), total.counts()[i]));
  }
  chart.vertical(total.percentile_us(0.5), "mark", "p50");
  chart.vertical(total.percentile_us(0.99), "mark", "p99");
  return text + chart.finish() + "</div></div>\n";
}

}  // namespace

std::string render_html(const ReportInput& input) {
  Summary summary = summarise(input.snapshots, input.truth);
  summary.checks.insert(summary.checks.end(), input.more_checks.begin(), input.more_checks.end());
  const TimeBase time(input.snapshots);
  std::string text =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Boresight report</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><style>";
  text += kStyle;
  text += fmt::format(
      "</style></head><body>\n<h1>Boresight report</h1>\n<p class=\"faint\">{} · {:.0f} s · {} radars</p>\n",
      escape(input.title), summary.duration_s, summary.radars.size());
  text += render_verdict(input, summary);
  text += render_table(summary);
  text += render_details(summary);
  text += render_truth(input, time, summary);
  text += render_alignment(input, time, summary);
  text += render_health(input, time, summary);
  text += render_tracks(input);
  text += render_latencies(summary);
  if (!input.events.empty()) {
    text += "<h2>Processes</h2>\n<pre>";
    for (const std::string& event : input.events) text += escape(event) + "\n";
    text += "</pre>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace boresight::report
