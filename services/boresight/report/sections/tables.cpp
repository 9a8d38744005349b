// Radars and their estimates as tables.
#include <fmt/format.h>

#include "services/boresight/monitor/render.hpp"
#include "services/boresight/report/sections/sections.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::report {

namespace {

std::string angle_text(const monitor::AngleEstimate& angle) {
  if (!angle.observable) return "<span class=\"faint\">not observable</span>";
  return text::with_std(angle.value_rad * kDegreesPerRadian, angle.std_rad * kDegreesPerRadian, "°",
                        text::Sign::kAlways);
}

}  // namespace

std::string render_table(const Summary& summary) {
  std::string text =
      "<h2>Radars</h2>\n<p class=\"faint\">Mounting error in yaw and scale of the speed signal (true speed / signalled "
      "speed), estimated while driving. σ is the standard deviation that the estimator states. Values are those at the "
      "end of the drive; deviation = estimate − truth.</p>\n<table><tr><th>radar</th><th class=n>scans</th><th "
      "class=n>lost</th>"
      "<th class=n>yaw error ± σ</th><th class=n>true yaw error</th><th class=n>deviation</th>"
      "<th class=n>speed scale ± σ</th><th>verdict</th></tr>\n";
  for (const RadarSummary& radar : summary.radars) {
    const RadarSnapshot& last = radar.last;
    const bool known = has_estimate(last);
    std::string deviation(text::kUnknown);
    if (known && radar.true_yaw_rad) {
      deviation = error_text(last.yaw, radar.true_yaw_rad);
    }
    text += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td>"
        "<td class=n>{}</td><td class=\"{}\">{}</td></tr>\n",
        escape(last.name), last.scans, last.lost, yaw_text(last), true_yaw_text(radar), deviation,
        speed_scale_text(last), last.data_qualifier == DataQualifier::kAvailable ? "good" : "bad",
        (radar.misaligned ? "MISALIGNED" : escape(monitor::verdict(last))) +
            (last.explanation.empty() ? "" : ": " + escape(last.explanation)));
  }
  return text + "</table>\n";
}

/// About the vehicle's axes, with the key figures.
std::string render_details(const Summary& summary) {
  std::string text =
      "<h2>Alignment at the end</h2>\n<p class=\"faint\">Mounting errors as rotations about the vehicle's axes. "
      "Settling time: driving time until the estimate stays within 5 % of its whole change. Residual: RMS of measured "
      "minus predicted range rate. Sudden misalignments: step changes of the mounting that the estimator "
      "reported.</p>\n"
      "<div class=\"wide\"><table><tr><th>radar</th><th class=n>yaw ± σ</th><th class=n>pitch ± σ</th><th class=n>roll "
      "± σ</th>"
      "<th class=n>settling time, yaw</th><th class=n>pitch</th><th class=n>yaw drift per minute</th>"
      "<th class=n>residual</th><th class=n>sudden misalignments</th></tr>\n";
  for (const RadarSummary& radar : summary.radars) {
    const monitor::AlignmentDetails& d = radar.last.details;
    const bool known = has_estimate(radar.last);
    const auto angle = [known](const monitor::AngleEstimate& a) {
      return known ? angle_text(a) : std::string(text::kUnknown);
    };
    text += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td>"
        "<td class=n>{}</td><td class=n>{}</td><td class=n>{}</td></tr>\n",
        escape(radar.last.name), angle(d.yaw), angle(d.pitch), angle(d.roll),
        text::fixed(d.yaw_seconds_to_95_percent, 1, " s"), text::fixed(d.pitch_seconds_to_95_percent, 1, " s"),
        text::fixed(d.yaw_drift_radpmin * kDegreesPerRadian, 3, "°"), text::fixed(d.residual_rmse_mps, 3, " m/s"),
        d.step_changes);
  }
  text += "</table></div>\n";
  if (summary.is_offline) {
    return text +
           "<p>The tables of an offline run do not hold settling times, drift, residuals, and the errors of the "
           "vehicle's signals.</p>\n";
  }
  for (const RadarSummary& radar : summary.radars) {
    if (!has_estimate(radar.last)) continue;
    const monitor::AngleEstimate &bias = radar.last.details.yaw_rate_bias, &slip = radar.last.details.slip;
    text +=
        fmt::format("<p>Errors of the vehicle's signals: yaw-rate bias {}; slip coefficient of the rear axle {}.</p>\n",
                    bias.observable ? text::with_std(bias.value_rad * kDegreesPerRadian,
                                                     bias.std_rad * kDegreesPerRadian, " °/s", text::Sign::kAlways)
                                    : "not observable",
                    slip.observable ? text::with_std(slip.value_rad, slip.std_rad, " rad per m/s²") : "not observable");
    break;
  }
  return text;
}

}  // namespace boresight::report
