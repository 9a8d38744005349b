#include "services/boresight/report/html_report.hpp"

#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"
#include "services/boresight/report/style.hpp"

namespace boresight::report {

std::string render_html(const ReportInput& input) {
  Summary summary = summarise(input.snapshots, input.truth);
  summary.pace = input.pace;
  summary.checks.insert(summary.checks.end(), input.more_checks.begin(), input.more_checks.end());
  const TimeBase time(input.snapshots, input.ghosts);
  std::string text =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Boresight report</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><style>";
  text += kStyle;
  text += fmt::format(
      "</style></head><body>\n<h1>Boresight report</h1>\n<p class=\"faint\">{} · {:.0f} s{} · {} radars</p>\n",
      escape(input.title), summary.duration_s, summary.pace.empty() ? "" : ", played " + summary.pace,
      summary.radars.size());
  text += render_verdict(input, summary);
  text += render_terms();
  text += render_table(summary);
  text += render_details(summary);
  text += render_truth(input, time, summary);
  text += render_alignment(input, time, summary);
  text += render_health(input, time, summary);
  text += render_labels(input, time, summary);
  text += render_confusion(input, time);
  text += render_plan_views(input, time);
  text += render_tracks(input);
  text += render_latencies(summary);
  if (!input.events.empty()) {
    text += "<h2>Processes</h2>\n<p class=\"faint\">Events that the supervisor reported.</p>\n<pre>";
    for (const std::string& event : input.events) text += escape(event) + "\n";
    text += "</pre>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace boresight::report
