#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Eigenvalues>

#include "services/alignment_estimator/core/reflectors/check.hpp"
#include "services/common/estimation/median.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::alignment::reflectors {

namespace {

constexpr double kShortest_m = 5.0;
constexpr double kTukeyOfLine = 4.685;

/// Tukey's weight of a residual in stds.
double tukey(double residual) {
  const double share = residual * residual / (kTukeyOfLine * kTukeyOfLine);
  return share < 1.0 ? (1.0 - share) * (1.0 - share) : 0.0;
}

/// Scatter of residuals (in stds), at least 1.
double scatter(const std::vector<double>& residuals) {
  std::vector<double> sizes = residuals;
  return std::max(1.0, estimation::mad_std(sizes, 0.0));
}

/// A value with its std; a std of 0: no value.
struct Slope {
  double value = 0.0, std = 0.0;
};

/// Robust straight line b = intercept + slope·a with stds of b: the median of the slopes of all pairs (Theil–Sen), then
/// least squares with Tukey's weights.
Slope robust_slope(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& std) {
  std::vector<double> slopes, offsets, residuals(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = i + 1; j < a.size(); ++j) {
      if (a[j] != a[i]) slopes.push_back((b[j] - b[i]) / (a[j] - a[i]));
    }
  }
  if (slopes.empty()) return {};
  double slope = estimation::median(slopes), intercept = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) offsets.push_back(b[i] - slope * a[i]);
  intercept = estimation::median(offsets);
  Slope result;
  for (int round = 0; round < 20; ++round) {
    for (std::size_t i = 0; i < a.size(); ++i) residuals[i] = (b[i] - intercept - slope * a[i]) / std[i];
    const double scale = scatter(residuals);
    double w = 0.0, wa = 0.0, wb = 0.0, waa = 0.0, wab = 0.0;
    double full = 0.0, full_a = 0.0, full_aa = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double believed = tukey(residuals[i] / scale), information = 1.0 / (std[i] * std[i] * scale * scale);
      const double weight = believed * information;
      w += weight, wa += weight * a[i], wb += weight * b[i], waa += weight * a[i] * a[i], wab += weight * a[i] * b[i];
      if (believed > 0.0) full += information, full_a += information * a[i], full_aa += information * a[i] * a[i];
    }
    const double determinant = w * waa - wa * wa;
    if (!(determinant > 0.0)) return {};
    slope = (w * wab - wa * wb) / determinant;
    intercept = (wb - slope * wa) / w;
    result = {slope, std::sqrt(full / (full * full_aa - full_a * full_a))};
  }
  return result;
}

/// Robust mean with stds.
Slope robust_mean(const std::vector<double>& values, const std::vector<double>& std) {
  std::vector<double> residuals(values.size());
  std::vector<double> sorted = values;
  Slope result{.value = estimation::median(sorted), .std = 0.0};
  for (int round = 0; round < 20; ++round) {
    for (std::size_t i = 0; i < values.size(); ++i) residuals[i] = (values[i] - result.value) / std[i];
    const double scale = scatter(residuals);
    double weights = 0.0, sum = 0.0, full = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double believed = tukey(residuals[i] / scale), information = 1.0 / (std[i] * std[i] * scale * scale);
      weights += believed * information;
      sum += believed * information * values[i];
      if (believed > 0.0) full += information;
    }
    result = {sum / weights, std::sqrt(1.0 / full)};
  }
  return result;
}

/// The surveyed line: middle and direction on the ground, and its problem if any.
struct SurveyedLine {
  Eigen::Vector2d middle, direction, normal;
  Problem problem = Problem::kNone;
  std::size_t position = 0;
  bool across = false;
};

SurveyedLine surveyed_line(std::span<const Position> positions, const Config& config) {
  SurveyedLine line;
  line.middle.setZero();
  for (const Position& position : positions) line.middle += position.surveyed_m.head<2>();
  line.middle /= static_cast<double>(positions.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Position& position : positions) {
    const Eigen::Vector2d off = position.surveyed_m.head<2>() - line.middle;
    spread += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  line.direction = axes.eigenvectors().col(1);
  line.across = std::abs(line.direction.y()) > std::abs(line.direction.x());
  // The direction points forward, or to the left.
  if (line.direction[line.across ? 1 : 0] < 0.0) line.direction = -line.direction;
  line.normal = {-line.direction.y(), line.direction.x()};
  double first = HUGE_VAL, last = -HUGE_VAL, farthest = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector2d off = positions[i].surveyed_m.head<2>() - line.middle;
    first = std::min(first, off.dot(line.direction));
    last = std::max(last, off.dot(line.direction));
    if (std::abs(off.dot(line.normal)) > farthest) {
      farthest = std::abs(off.dot(line.normal));
      line.position = i;
    }
  }
  const double skew = std::asin(std::clamp(line.direction[line.across ? 0 : 1], -1.0, 1.0));
  if (last - first < kShortest_m) {
    line.problem = Problem::kLineTooShort;
  } else if (farthest > config.line_tolerance_m) {
    line.problem = Problem::kNotALine;
  } else if (std::abs(skew) > config.skew_tolerance_rad) {
    line.problem = Problem::kSkewLine;
  }
  return line;
}

}  // namespace

LineResult fit_line(std::span<const Position> positions, const RadarConfig& radar, const Config& config) {
  LineResult result;
  std::tie(result.problem, result.problem_position) = check(positions, radar, config);
  if (!result.ok()) return result;
  const SurveyedLine line = surveyed_line(positions, config);
  result.problem = line.problem;
  result.problem_position = line.position;
  result.across = line.across;
  if (!result.ok()) return result;

  // Measured positions under the nominal mounting: they are rotated against the surveyed ones by the mounting error.
  const Eigen::Vector3d place = place_of(radar);
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
  std::vector<double> along, beside, beside_std, pitches, pitch_stds;
  for (const Position& position : positions) {
    const double elevation = config.has_elevation ? position.elevation_rad : 0.0;
    const Eigen::Vector3d seen = nominal * geometry::direction(position.azimuth_rad, elevation);
    const Eigen::Vector2d off = (place + position.range_m * seen).head<2>() - line.middle;
    along.push_back(off.dot(line.direction));
    beside.push_back(off.dot(line.normal));
    const Eigen::Vector2d ahead = seen.head<2>().normalized(), aside(-ahead.y(), ahead.x());
    const double factor = median_factor(position.scans);
    const double by_range = radar.noise.range_std_m * factor * ahead.dot(line.normal);
    const double by_azimuth = position.range_m * radar.noise.azimuth_std_rad * factor * aside.dot(line.normal);
    beside_std.push_back(std::hypot(by_range, by_azimuth, config.survey_std_m));
    const Eigen::Vector3d way = position.surveyed_m - place;
    // Elevation against the height difference; a radar that looks up sees reflectors too low.
    pitches.push_back(std::atan2(way.z(), way.head<2>().norm()) - std::asin(std::clamp(seen.z(), -1.0, 1.0)));
    pitch_stds.push_back(std::hypot(radar.noise.elevation_std_rad * factor, config.height_std_m / way.norm()));
  }
  const Slope slope = robust_slope(along, beside, beside_std);
  if (!(slope.std > 0.0)) {
    result.problem = Problem::kTooFewAgree;
    return result;
  }
  // The measured line is rotated by minus the yaw error against the surveyed one.
  result.yaw_rad = -std::atan(slope.value);
  result.yaw_std_rad = slope.std;
  if (config.has_elevation) {
    const Slope pitch = robust_mean(pitches, pitch_stds);
    result.pitch_rad = pitch.value;
    result.pitch_std_rad = pitch.std;
  }
  return result;
}

}  // namespace boresight::alignment::reflectors
