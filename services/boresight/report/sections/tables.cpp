// Radars and their estimates as tables.
#include <fmt/format.h>

#include "services/boresight/monitor/render.hpp"
#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

namespace {

std::string known_angle(const monitor::AngleEstimate& angle) {
  if (!angle.observable) return "<span class=\"faint\">not observable</span>";
  return fmt::format("{:+.2f}° ± {:.2f}°", angle.value_rad * kDegrees, angle.std_rad * kDegrees);
}

}  // namespace

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
        known_number(d.yaw_drift_radpmin * kDegrees, "°", 3), known_number(d.residual_rmse_mps, "", 3), d.step_changes);
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

}  // namespace boresight::report
