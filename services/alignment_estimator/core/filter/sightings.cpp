#include "services/alignment_estimator/core/filter/sightings.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::alignment {

namespace {

/// No relative speed on a road is beyond.
constexpr double kMaxRangeRate_mps = 200.0;
/// What stands beside and over roads is at most this high: the clearance of structures (German RAA: 4.70 m).
constexpr double kClearance_m = 4.7;
/// Nothing is nearer, and no sensor looks up more steeply.
constexpr double kNearest_m = 1.0, kSteepest_rad = 1.0;
/// Share of the heights below which their density counts as constant.
constexpr double kNarrow = 1e-3;

/// Moments 0 to 4 over heights up to the share u: all things stand on the road, as likely of one height as of another,
/// and reflect anywhere between the road and their top, so that the density of reflectors is −ln u.
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
  // Uniform over this has the variance of a direction in the view plus that of the axis.
  const double reach = std::sqrt(half * half + 3.0 * rotation_std_rad * rotation_std_rad);
  lowest_sine_ = std::sin(std::clamp(axis - reach, -kSteepest_rad, kSteepest_rad));
  highest_sine_ = std::sin(std::clamp(axis + reach, -kSteepest_rad, kSteepest_rad));
}

UnknownElevation::Cosine UnknownElevation::at(double range_m) const {
  const double range = range_m > kNearest_m ? range_m : kNearest_m;  // also of what is not a number
  // Of shares u of the greatest height; the elevation's sine is (u − own)·steepness, its cosine 1 − sine²/2 − sine⁴/8.
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

void take_sightings(const ScanDetections& scan, const RadarConfig& radar, const UnknownElevation& unknown, double edge,
                    double angle_scale, Sightings& out) {
  out.has_elevation = scan.has_elevation;
  out.ambiguity_mps = std::isfinite(scan.ambiguity_mps) && scan.ambiguity_mps > 0.1 ? scan.ambiguity_mps : 0.0;
  std::size_t n = 0;
  const std::size_t count = std::min(scan.count, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = scan.azimuth_rad[i], elevation = scan.elevation_rad[i], rate = scan.range_rate_mps[i];
    // Written so that what is not a number is left out as well.
    if (!(std::abs(azimuth) <= M_PI && std::abs(elevation) < 1.5 && std::abs(rate) < kMaxRangeRate_mps)) continue;
    double azimuth_std = scan.azimuth_std_rad[i];
    const double elevation_std = scan.elevation_std_rad[i], rate_std = scan.range_rate_std_mps[i];
    if (!(azimuth_std > 0.0 && elevation_std > 0.0 && rate_std > 0.0)) continue;
    const double ca = std::cos(azimuth), sa = std::sin(azimuth);
    double slope = 0.0;
    // An antenna's aperture shrinks with the cosine; sensors that state σ have that in them.
    if (azimuth_std == radar.noise.azimuth_std_rad && edge < 1.0) {
      azimuth_std /= std::max(ca, edge);
      if (ca > edge) slope = sa / ca;
    }
    azimuth_std = std::min(azimuth_std, 0.5);
    out.azimuth_variance[n] = azimuth_std * azimuth_std;
    out.azimuth_std_slope[n] = slope;
    out.range_rate_variance[n] = rate_std * rate_std;
    out.range_rate_mps[n] = rate;
    // The mean of a noisy angle's cosine is shorter by exp(−σ²/2).
    const double stretch_azimuth = 1.0 + 0.5 * angle_scale * out.azimuth_variance[n];
    if (scan.has_elevation) {
      const double bounded = std::min(elevation_std, 0.5);
      out.elevation_variance[n] = bounded * bounded;
      const double stretch = 1.0 + 0.5 * angle_scale * out.elevation_variance[n];
      const double ce = std::cos(elevation);
      out.x[n] = ce * ca * stretch_azimuth * stretch;
      out.y[n] = ce * sa * stretch_azimuth * stretch;
      out.z[n] = std::sin(elevation) * stretch;
      out.lowering[n] = out.lowering_variance[n] = out.mean_sine[n] = 0.0;
    } else {
      const UnknownElevation::Cosine cosine = unknown.at(scan.range_m[i]);
      out.elevation_variance[n] = 0.0;
      out.x[n] = (1.0 - cosine.lowering) * ca * stretch_azimuth;
      out.y[n] = (1.0 - cosine.lowering) * sa * stretch_azimuth;
      out.z[n] = 0.0;
      out.lowering[n] = cosine.lowering;
      out.lowering_variance[n] = cosine.relative_variance;
      out.mean_sine[n] = cosine.mean_sine;
    }
    ++n;
  }
  out.count = n;
}

}  // namespace boresight::alignment
