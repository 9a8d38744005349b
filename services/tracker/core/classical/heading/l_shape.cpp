#include "services/tracker/core/classical/heading/l_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking::classical {

namespace {

constexpr std::size_t kDirections = 30;  // 3 degrees apart
constexpr double kQuarter_rad = 0.5 * std::numbers::pi;
constexpr double kStep_rad = kQuarter_rad / static_cast<double>(kDirections);

/// The detections in the axes of one direction.
struct Outline {
  Eigen::Vector2d e1, e2;
  double low1 = std::numeric_limits<double>::infinity(), high1 = -low1, low2 = low1, high2 = -low1;
  bool first1 = true, first2 = true;  // whether the face is at the low end

  Outline(std::span<const HistoryPoint> points, double rad)
      : e1(std::cos(rad), std::sin(rad)), e2(-std::sin(rad), std::cos(rad)) {
    double sum1 = 0.0, sum2 = 0.0;
    for (const HistoryPoint& p : points) {
      const double c1 = e1.dot(p.place_m), c2 = e2.dot(p.place_m);
      low1 = std::min(low1, c1);
      high1 = std::max(high1, c1);
      low2 = std::min(low2, c2);
      high2 = std::max(high2, c2);
      sum1 += e1.dot(p.sight);
      sum2 += e2.dot(p.sight);
    }
    // The face that looks at the sensor is where the lines of sight arrive first.
    first1 = sum1 >= 0.0;
    first2 = sum2 >= 0.0;
  }
  /// Distances from the two faces.
  [[nodiscard]] std::array<double, 2> distances(const HistoryPoint& p) const {
    const double c1 = e1.dot(p.place_m), c2 = e2.dot(p.place_m);
    return {first1 ? c1 - low1 : high1 - c1, first2 ? c2 - low2 : high2 - c2};
  }
};

/// Variance of a sum's values.
struct Spread {
  double n = 0.0, sum = 0.0, squares = 0.0;
  void add(double x) {
    n += 1.0;
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double variance() const { return n > 0.0 ? squares / n - sum * sum / (n * n) : 0.0; }
};

double score(const Outline& outline, std::span<const HistoryPoint> points, const ShapeParameters& parameters) {
  if (parameters.criterion == ShapeCriterion::kArea) {
    return -(outline.high1 - outline.low1) * (outline.high2 - outline.low2);
  }
  double closeness = 0.0;
  Spread first, second;
  for (const HistoryPoint& p : points) {
    const auto [d1, d2] = outline.distances(p);
    closeness += 1.0 / std::max(std::min(d1, d2), parameters.nearest_m);
    if (d1 < d2) {
      first.add(d1);
    } else {
      second.add(d2);
    }
  }
  return parameters.criterion == ShapeCriterion::kCloseness ? closeness : -first.variance() - second.variance();
}

}  // namespace

std::optional<Heading> l_shape_heading(std::span<const HistoryPoint> points, double near_rad,
                                       const ShapeParameters& parameters) {
  if (points.size() < parameters.least_points) return std::nullopt;
  std::array<double, kDirections> chi2{};
  double best = -std::numeric_limits<double>::infinity(), least = -best;
  std::size_t winner = 0;
  const double face_m2 = parameters.face_std_m * parameters.face_std_m;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const Outline outline(points,
                          near_rad + (static_cast<double>(k) - 0.5 * static_cast<double>(kDirections)) * kStep_rad);
    const double value = score(outline, points, parameters);
    if (value > best) {
      best = value;
      winner = k;
    }
    for (const HistoryPoint& p : points) {
      const auto [d1, d2] = outline.distances(p);
      const double d = std::min(d1, d2);
      chi2[k] += d * d / (face_m2 + p.variance_m2);
    }
    least = std::min(least, chi2[k]);
  }
  // More scatter than the deviations say makes the direction less sure by as much. An outline has four parameters.
  const double freedom = std::max(1.0, static_cast<double>(points.size()) - 4.0),
               scale = std::max(1.0, least / freedom);
  const auto direction_rad = [](std::size_t k) {
    return (static_cast<double>(k) - 0.5 * static_cast<double>(kDirections)) * kStep_rad;
  };
  double weights = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double weight = std::exp(-0.5 * (chi2[k] - least) / scale);
    const double off = std::remainder(direction_rad(k) - direction_rad(winner), kQuarter_rad);
    weights += weight;
    squares += weight * off * off;
  }
  return Heading{geometry::wrap_angle(near_rad + direction_rad(winner)),
                 squares / weights + kStep_rad * kStep_rad / 12.0};
}

}  // namespace boresight::tracking::classical
