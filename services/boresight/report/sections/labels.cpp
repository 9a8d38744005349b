// How the ghost filter classified the detections.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "services/boresight/report/sections/label_style.hpp"
#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

namespace {

using monitor::LabelCounts;

std::string row(const std::string& radar, const LabelCounts& labels) {
  const auto all = static_cast<double>(labels.detections());
  const auto cell = [all](std::uint64_t count) {
    return fmt::format("<td class=n title=\"{}\">{}</td>", count,
                       all > 0.0 ? fmt::format("{:.2f} %", 100.0 * static_cast<double>(count) / all) : "–");
  };
  std::string text = fmt::format("<tr><td>{}</td><td class=n>{}</td>", radar, labels.detections());
  for (const LabelStyle& style : kLabelStyles) text += cell(labels.of(style.label));
  return text + cell(labels.rejected) +
         fmt::format("<td class=n>{} of {}</td></tr>\n", labels.scans_without_tracks, labels.scans);
}

LabelCounts sum_of(const Snapshot& snapshot) {
  LabelCounts sum;
  for (const RadarSnapshot& radar : snapshot.radars) {
    for (std::size_t i = 0; i < sum.classified.size(); ++i) sum.classified[i] += radar.labels.classified[i];
    sum.rejected += radar.labels.rejected;
  }
  return sum;
}

/// Shares between one snapshot and the next, in percent, stacked from below: moving, ghosts, clutter, ambiguities.
std::string render_shares(const ReportInput& input, const TimeBase& time) {
  constexpr std::array kDrawn = {Provenance::kMoving, Provenance::kGhostType1, Provenance::kGhostType2,
                                 Provenance::kClutter, Provenance::kAmbiguity};
  std::array<std::vector<Point>, kDrawn.size() + 1> edges;
  double highest = 5.0;
  for (std::size_t i = 1; i < input.snapshots.size(); ++i) {
    const LabelCounts before = sum_of(input.snapshots[i - 1]), after = sum_of(input.snapshots[i]);
    const std::uint64_t all = after.detections() - before.detections();
    // No new detections, or the monitor was restarted.
    if (after.detections() <= before.detections()) continue;
    const double t_s = 0.5 * (time.seconds(input.snapshots[i - 1]) + time.seconds(input.snapshots[i]));
    double sum = 0.0;
    edges[0].push_back({t_s, 0.0});
    for (std::size_t k = 0; k < kDrawn.size(); ++k) {
      sum += 100.0 * static_cast<double>(after.of(kDrawn[k]) - before.of(kDrawn[k])) / static_cast<double>(all);
      edges[k + 1].push_back({t_s, sum});
    }
    highest = std::max(highest, 1.1 * sum);
  }
  if (edges[0].size() < 2) return {};
  Chart chart(1080, 230, {.min = 0, .max = time.end_s(), .label = "time, s"},
              {.min = 0, .max = std::min(100.0, highest), .label = "of all detections, %"});
  std::string legend;
  for (std::size_t k = 0; k < kDrawn.size(); ++k) {
    const LabelStyle& style = style_of(kDrawn[k]);
    chart.band(edges[k], edges[k + 1], style.area());
    legend = svg::page_key(svg::area_sample(style.area())) + style.words + legend;
  }
  return "<p class=\"legend\">" + legend +
         " (stacked from top to bottom; the rest to 100 % is stationary, rejected or not classified)</p>\n" +
         chart.finish();
}

}  // namespace

std::string render_labels(const ReportInput& input, const TimeBase& time, const Summary& summary) {
  std::string text =
      "<h2>Ghost filter: classification of detections</h2>\n<p class=\"faint\">Labels (provenance) that the "
      "ghost filter published, in percent of all detections. Ghost type 1: the last reflection is at the object, so "
      "the "
      "ghost appears in the direction of the object, behind it. Ghost type 2: the last reflection is at the mirror, so "
      "the ghost appears behind the mirror. Rejected: the corrector rejected the detection as invalid, weak or outside "
      "the region of interest, and no later stage uses it.</p>\n";
  if (summary.labels.detections() == 0) return text + "<p>No scan of the ghost filter was received.</p>\n";
  text += "<div class=\"wide\"><table><tr><th>radar</th><th class=n>detections</th>";
  for (const LabelStyle& style : kLabelStyles) text += fmt::format("<th class=n>{}</th>", style.words);
  text += "<th class=n>rejected</th><th class=n>scans classified without tracks</th></tr>\n";
  for (const RadarSummary& radar : summary.radars) text += row(escape(radar.last.name), radar.last.labels);
  return text + row("<b>all</b>", summary.labels) + "</table></div>\n" + render_shares(input, time);
}

}  // namespace boresight::report
