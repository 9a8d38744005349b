// How long scans take, stage by stage.
#include <algorithm>

#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

std::string render_latencies(const Summary& summary) {
  if (summary.is_offline) {
    return "<h2>Latency</h2>\n<p>An offline run has no latencies; its run.json states the CPU time of each "
           "stage.</p>\n";
  }
  std::string text =
      "<h2>Latency</h2>\n<div class=\"grid2\"><div>\n<table><tr><th>stage</th><th class=n>p50, µs</th>"
      "<th class=n>p99, µs</th><th class=n>max, µs</th></tr>\n";
  for (std::size_t i = 0; i < monitor::kNumberOfLatencies; ++i) {
    const LatencyHistogram& h = summary.latencies[i];
    text += fmt::format("<tr><td>{}</td><td class=n>{:.0f}</td><td class=n>{:.0f}</td><td class=n>{:.0f}</td></tr>\n",
                        monitor::kLatencyNames[i], h.percentile_us(0.5), h.percentile_us(0.99), h.max_us());
  }
  text +=
      "</table>\n<p class=\"faint\">A stage is measured from taking its input to publishing its output. The total is "
      "measured "
      "from reception of the scan's last frame to the published track list and includes all waiting.</p>";
  if (!summary.pace.empty()) text += "<p class=\"faint\">Not played in real time: latencies have no verdict.</p>";
  text += "</div><div>\n";
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
  Chart chart(520, 250,
              {.min = LatencyHistogram::edge_us(first > 2 ? first - 2 : 0),
               .max = LatencyHistogram::edge_us(last + 3),
               .label = "reception to track list, µs",
               .logarithmic = true},
              {.min = 0, .max = 1.15 * static_cast<double>(highest), .label = "scans"});
  for (std::size_t i = first; i <= last; ++i) {
    chart.rectangle({LatencyHistogram::edge_us(i), 0},
                    {LatencyHistogram::edge_us(i + 1), static_cast<double>(total.counts()[i])},
                    svg::area_of(svg::kBlue),
                    fmt::format("{:.0f} to {:.0f} µs: {}", LatencyHistogram::edge_us(i),
                                LatencyHistogram::edge_us(i + 1), total.counts()[i]));
  }
  chart.vertical(total.percentile_us(0.5), svg::kMark, "p50");
  chart.vertical(total.percentile_us(0.99), svg::kMark, "p99");
  return text + chart.finish() + "</div></div>\n";
}

}  // namespace boresight::report
