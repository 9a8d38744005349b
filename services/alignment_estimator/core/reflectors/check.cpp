#include "services/alignment_estimator/core/reflectors/check.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/frames.hpp"

namespace boresight::alignment::reflectors {

std::string_view explain(Problem problem) {
  switch (problem) {
    case Problem::kNone:
      return "no problem";
    case Problem::kTooFewPositions:
      return "too few reflector positions";
    case Problem::kNotFinite:
      return "a value is not a number";
    case Problem::kOutOfRange:
      return "a reflector is nearer or farther than allowed";
    case Problem::kOutOfView:
      return "a reflector is behind the nominally mounted radar";
    case Problem::kTooFewAgree:
      return "at most half of the positions fit one rotation of the radar";
    case Problem::kNotALine:
      return "a reflector is not on the line of the others";
    case Problem::kLineTooShort:
      return "the line of reflectors is shorter than 5 m";
    case Problem::kSkewLine:
      return "the line of reflectors is neither along nor square to the driving direction";
  }
  return "?";
}

std::pair<Problem, std::size_t> check(std::span<const Position> positions, const RadarConfig& radar,
                                      const Config& config) {
  if (positions.size() < config.min_positions) return {Problem::kTooFewPositions, positions.size()};
  const Eigen::Vector3d place = place_of(radar);
  const Eigen::Vector3d boresight =
      geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0) * Eigen::Vector3d::UnitX();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Position& position = positions[i];
    const bool finite = position.surveyed_m.allFinite() && std::isfinite(position.range_m) &&
                        std::isfinite(position.azimuth_rad) &&
                        (!config.has_elevation || std::isfinite(position.elevation_rad));
    if (!finite) return {Problem::kNotFinite, i};
    const Eigen::Vector3d way = position.surveyed_m - place;
    if (way.norm() < config.range_min_m || way.norm() > config.range_max_m) return {Problem::kOutOfRange, i};
    if (way.dot(boresight) <= 0.0) return {Problem::kOutOfView, i};
  }
  return {Problem::kNone, 0};
}

double median_factor(std::size_t scans) {
  // √(π/2)/√n for many values; one value, and the mean of two, are special cases.
  const double n = static_cast<double>(std::max<std::size_t>(scans, 1));
  return n <= 2.0 ? 1.0 / std::sqrt(n) : std::sqrt(M_PI / 2.0 / n);
}

}  // namespace boresight::alignment::reflectors
