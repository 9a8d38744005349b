#include "services/simulator/alignment/reflection_draws.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/angles.hpp"

namespace boresight::simulator {

namespace {

/// Height of a reflector relative to the radar: kerbs and cars, fences, façades.
double draw_height_m(Stream& stream) {
  const double sort = stream.uniform();
  if (sort < 0.35) return stream.uniform(-0.55, 0.3);
  if (sort < 0.75) return stream.uniform(-0.3, 2.0);
  return stream.uniform(0.0, 8.0);
}

}  // namespace

View view_of(const RadarConfig& radar) {
  const FieldOfView& f = radar.field_of_view;
  const double azimuth_margin = std::min(5.0 * kRadiansPerDegree, (f.azimuth_max_rad - f.azimuth_min_rad) / 12.0);
  const double elevation_margin = std::min(3.0 * kRadiansPerDegree, (f.elevation_max_rad - f.elevation_min_rad) / 12.0);
  View view{f.azimuth_min_rad + azimuth_margin, f.azimuth_max_rad - azimuth_margin,
            f.elevation_min_rad + elevation_margin, f.elevation_max_rad - elevation_margin};
  if (std::cos(radar.mounting_pose.roll_rad) < 0.0) {
    view = {-view.azimuth_max_rad, -view.azimuth_min_rad, -view.elevation_max_rad, -view.elevation_min_rad};
  }
  view.elevation_min_rad += radar.mounting_pose.pitch_rad;
  view.elevation_max_rad += radar.mounting_pose.pitch_rad;
  return view;
}

double draw_elevation_rad(ElevationKind kind, const View& view, double range_m, Stream& stream) {
  double elevation = 0.0;
  if (kind == ElevationKind::kUniform) elevation = stream.uniform(-0.02, 0.06);
  if (kind == ElevationKind::kScene) {
    elevation = std::asin(std::clamp(draw_height_m(stream) / range_m, -0.9, 0.9));
    constexpr double kMargin_rad = 2.0 * kRadiansPerDegree;
    const bool seen =
        elevation > view.elevation_min_rad + kMargin_rad && elevation < view.elevation_max_rad - kMargin_rad;
    if (!seen) elevation = 3.0 * kRadiansPerDegree * stream.gaussian();
  }
  return std::clamp(elevation, view.elevation_min_rad, view.elevation_max_rad);
}

double draw_azimuth_rad(const View& view, Stream& stream) {
  if (stream.uniform() >= 0.35) return view.azimuth(stream.uniform());
  return std::clamp(view.azimuth(0.5) + 25.0 * kRadiansPerDegree * stream.gaussian(), view.azimuth_min_rad,
                    view.azimuth_max_rad);
}

}  // namespace boresight::simulator
