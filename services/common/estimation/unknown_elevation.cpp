#include "services/common/estimation/unknown_elevation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace boresight {

namespace {

/// Largest height of stationary objects beside and over roads: the clearance of structures (German RAA: 4.70 m).
constexpr double kClearance_m = 4.7;
/// Smallest range, and largest elevation of a sensor's view.
constexpr double kNearest_m = 1.0, kSteepest_rad = 1.0;
/// Interval of heights, as a share of the largest, below which their density is taken as constant.
constexpr double kNarrow = 1e-3;

/// Moments 0 to 4 over heights up to the share u of the largest height. Model: all objects stand on the road, with
/// uniformly distributed heights, and reflect uniformly between the road and their top. The density of reflectors is
/// then −ln u.
std::array<double, 5> moments(double u) {
  std::array<double, 5> out{};
  if (!(u > 0.0)) return out;
  const double log = -std::log(u);
  double power = u;
  for (std::size_t n = 0; n < out.size(); ++n, power *= u) {
    const double inverse = 1.0 / static_cast<double>(n + 1);
    out[n] = power * inverse * (log + inverse);
  }
  return out;
}

}  // namespace

UnknownElevation::UnknownElevation(const RadarConfig& radar, double rotation_std_rad)
    : height_m_(std::max(0.0, radar.mounting_pose.position_m[2])), highest_m_(std::max(kClearance_m, 2.0 * height_m_)) {
  const FieldOfView& view = radar.field_of_view;
  const bool usable = std::isfinite(view.elevation_min_rad) && std::isfinite(view.elevation_max_rad);
  const double centre = usable ? 0.5 * (view.elevation_min_rad + view.elevation_max_rad) : 0.0;
  const double half = usable ? 0.5 * std::abs(view.elevation_max_rad - view.elevation_min_rad) : M_PI;
  const double upright = std::cos(radar.mounting_pose.roll_rad) < 0.0 ? -1.0 : 1.0;
  const double axis = radar.mounting_pose.pitch_rad + upright * centre;
  // A uniform distribution over ±reach has the variance of a direction in the view plus that of the axis.
  const double reach = std::sqrt(half * half + 3.0 * rotation_std_rad * rotation_std_rad);
  lowest_sine_ = std::sin(std::clamp(axis - reach, -kSteepest_rad, kSteepest_rad));
  highest_sine_ = std::sin(std::clamp(axis + reach, -kSteepest_rad, kSteepest_rad));
}

UnknownElevation::Cosine UnknownElevation::at(double range_m) const {
  const double range = range_m > kNearest_m ? range_m : kNearest_m;  // also for NaN
  // Heights are shares u of the largest height; sine of elevation (u − own)·steepness, cosine 1 − sine²/2 − sine⁴/8.
  const double own = height_m_ / highest_m_, steepness = highest_m_ / range;
  const double low = std::clamp(own + lowest_sine_ / steepness, 0.0, 1.0);
  const double high = std::clamp(own + highest_sine_ / steepness, 0.0, 1.0);
  double mean_sine = 0.0, square = 0.0, fourth = 0.0;
  if (high - low < kNarrow) {
    mean_sine = std::clamp((0.5 * (low + high) - own) * steepness, -1.0, 1.0);
    square = mean_sine * mean_sine;
    fourth = square * square;
  } else {
    const std::array<double, 5> below = moments(low), all = moments(high);
    std::array<double, 5> m;
    for (std::size_t n = 0; n < m.size(); ++n) m[n] = (all[n] - below[n]) / (all[0] - below[0]);
    const double s2 = steepness * steepness, o2 = own * own;
    mean_sine = steepness * (m[1] - own);
    square = s2 * (m[2] - 2.0 * own * m[1] + o2);
    fourth = s2 * s2 * (m[4] - 4.0 * own * m[3] + 6.0 * o2 * m[2] - 4.0 * o2 * own * m[1] + o2 * o2);
  }
  const double lowering = 0.5 * square + 0.125 * fourth, mean = 1.0 - lowering;
  return {lowering, 0.25 * std::max(0.0, fourth - square * square) / (mean * mean), mean_sine};
}

}  // namespace boresight
