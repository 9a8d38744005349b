// Conditions of radars and services over time.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "services/boresight/monitor/render.hpp"
#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

namespace {

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

}  // namespace

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

}  // namespace boresight::report
