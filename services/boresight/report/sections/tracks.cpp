// Tracks seen from above.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

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
  Chart chart(1080, 46.0 + 2.0 * aside_m * px_per_m, {.min = -ahead_m, .max = ahead_m, .label = "ahead, m"},
              {.min = -aside_m, .max = aside_m, .label = "left, m"});
  for (const RadarConfig& radar : input.vehicle.radars) {
    std::vector<Point> sector = {{radar.mounting_pose.position_m[0], radar.mounting_pose.position_m[1]}};
    for (int i = 0; i <= 12; ++i) {
      const double azimuth_rad =
          radar.field_of_view.azimuth_min_rad +
          (radar.field_of_view.azimuth_max_rad - radar.field_of_view.azimuth_min_rad) * i / 12.0 +
          radar.mounting_pose.yaw_rad;
      constexpr double kDrawn_m = 12.0;  // shows the direction of each radar, not its range
      sector.push_back(
          {sector[0].x + kDrawn_m * std::cos(azimuth_rad), sector[0].y + kDrawn_m * std::sin(azimuth_rad)});
    }
    chart.band({}, sector, svg::kUncertainty);
  }
  chart.rectangle({-1.0, -0.9}, {3.7, 0.9}, svg::area_of(svg::kInk), "the vehicle");
  for (const auto& [id, points] : trails) {
    if (points.size() < 2) continue;
    chart.line(points, svg::series(id));
    chart.dot(points.back(), 2.5, svg::area_of(svg::kInk), fmt::format("track #{}", id));
  }
  return fmt::format(
             "<h2>Tracks</h2>\n<p class=\"faint\">Paths of {} confirmed tracks relative to the vehicle, seen from "
             "above. "
             "A dot is the last position of a track. The shaded sectors show the direction of each radar, not its "
             "range.</p>\n",
             trails.size()) +
         chart.finish();
}

}  // namespace boresight::report
