// Where a radar of the alignment drive sees reflections: random directions and heights.
#pragma once

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/alignment/spec.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator {

/// Directions in which detections are drawn, relative to the horizon ahead of the radar's nominal boresight.
struct View {
  double azimuth_min_rad, azimuth_max_rad, elevation_min_rad, elevation_max_rad;
  [[nodiscard]] double azimuth(double share) const {
    return azimuth_min_rad + (azimuth_max_rad - azimuth_min_rad) * share;
  }
};

/// The range of directions is a little smaller than the field of view, so that a misaligned radar still measures within
/// it. For a radar mounted upside down, left and right of its own frame are swapped.
[[nodiscard]] View view_of(const RadarConfig& radar);

/// Elevation of a reflection at `range_m`, rad, within the view.
[[nodiscard]] double draw_elevation_rad(ElevationKind kind, const View& view, double range_m, Stream& stream);

/// Azimuth of a detection, rad: fewer towards the edge of the field of view, as by an antenna pattern.
[[nodiscard]] double draw_azimuth_rad(const View& view, Stream& stream);

}  // namespace boresight::simulator
