// Conditions of radars and services over time.
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "services/boresight/monitor/render.hpp"
#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

namespace {

std::string_view colour_of(const RadarSnapshot& radar) {
  if (radar.data_qualifier == DataQualifier::kAvailable) return svg::kGreen;
  if (radar.extended_qualifier == ExtendedQualifier::kInitialising) return svg::kLightGrey;
  return radar.data_qualifier == DataQualifier::kAvailableReduced ? svg::kAmber : svg::kRed;
}

std::string_view colour_of(ServiceCondition condition) {
  switch (condition) {
    case ServiceCondition::kAlive:
      return svg::kGreen;
    case ServiceCondition::kDegraded:
    case ServiceCondition::kRestarted:
      return svg::kAmber;
    case ServiceCondition::kSilent:
      return svg::kRed;
    case ServiceCondition::kUnknown:
      break;
  }
  return svg::kLightGrey;
}

/// A part of a timeline with one state.
struct Stretch {
  double from_s;
  double to_s;
  std::string_view colour;
  std::string state;
};

void draw_rows(Chart& chart, const std::vector<std::pair<std::string, std::vector<Stretch>>>& rows) {
  double y = static_cast<double>(rows.size());
  for (const auto& [name, stretches] : rows) {
    y -= 1.0;
    for (const Stretch& s : stretches) {
      chart.rectangle({s.from_s, y + 0.12}, {s.to_s, y + 0.6}, svg::area_of(s.colour),
                      fmt::format("{}: {} ({:.1f} to {:.1f} s)", name, s.state, s.from_s, s.to_s));
    }
    chart.text({0.0, y + 0.68}, " " + name);
  }
}

}  // namespace

std::string render_health(const ReportInput& input, const TimeBase& time, const Summary& summary) {
  std::vector<std::pair<std::string, std::vector<Stretch>>> rows;
  const auto extend = [&time, &rows](std::size_t row, const Snapshot& s, std::string_view colour, std::string state) {
    const double t_s = std::max(0.0, time.seconds(s));
    auto& stretches = rows[row].second;
    if (!stretches.empty()) stretches.back().to_s = t_s;
    if (stretches.empty() || stretches.back().state != state) stretches.push_back({t_s, t_s, colour, std::move(state)});
  };
  for (const RadarSummary& radar : summary.radars) rows.emplace_back(radar.last.name, std::vector<Stretch>());
  for (const auto& service : summary.services)
    rows.emplace_back(catalogue::name_of(service.service), std::vector<Stretch>());
  for (const Snapshot& snapshot : input.snapshots) {
    for (std::size_t i = 0; i < summary.radars.size(); ++i) {
      const RadarSnapshot* const seen = find_radar(snapshot, summary.radars[i].last.id);
      if (seen != nullptr) extend(i, snapshot, colour_of(*seen), monitor::verdict(*seen));
    }
    for (std::size_t i = 0; i < std::min(summary.services.size(), snapshot.services.size()); ++i) {
      const ServiceCondition condition = snapshot.services[i].condition;
      extend(summary.radars.size() + i, snapshot, colour_of(condition), std::string(name_of(condition)));
    }
  }
  const auto count = static_cast<double>(rows.size());
  Chart chart(1080, 46 + 34 * count, {.min = 0, .max = time.end_s(), .label = "time, s"},
              {.min = 0, .max = count, .label = ""});
  draw_rows(chart, rows);
  const auto key = [](std::string_view colour) { return svg::page_key(svg::area_sample(svg::area_of(colour))); };
  return "<h2>Health over time</h2>\n<p class=\"faint\">" +
         std::string(!summary.is_offline ? "Verdict of the health service on each radar and each service."
                                         : "Verdict of health on each radar; no services run offline.") +
         "</p>\n<p class=\"legend\">" + key(svg::kGreen) + "available, alive" + key(svg::kAmber) +
         "reduced, degraded, restarted" + key(svg::kRed) + "not available, silent" + key(svg::kLightGrey) +
         "no verdict yet</p>\n" + chart.finish();
}

}  // namespace boresight::report
