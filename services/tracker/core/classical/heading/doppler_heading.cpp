#include "services/tracker/core/classical/heading/doppler_heading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking::classical {

namespace {

/// Variance of the direction of a velocity, with what an unknown turn rate adds across it.
double direction_variance(const Eigen::Vector2d& velocity, const Eigen::Matrix2d& covariance, double turn_mps) {
  const double speed2 = velocity.squaredNorm();
  const Eigen::Vector2d across(-velocity.y(), velocity.x());
  return (across.dot(covariance * across) / speed2 + turn_mps * turn_mps) / speed2;
}

}  // namespace

std::optional<DopplerHeading> doppler_line(std::span<const HistoryPoint> points, const DopplerParameters& parameters,
                                           double turn_mps) {
  if (points.size() < parameters.least_points) return std::nullopt;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const HistoryPoint& p : points) {
    information += p.sight * p.sight.transpose() / p.range_rate_variance;
    sum += p.sight * (p.range_rate_mps / p.range_rate_variance);
  }
  // All lines of sight alike: the velocity across them is unknown.
  if (information.determinant() <= 1e-9 * information.trace() * information.trace()) return std::nullopt;
  const Eigen::Matrix2d covariance = information.inverse();
  const Eigen::Vector2d velocity = covariance * sum;
  const double speed = velocity.norm();
  if (speed < parameters.least_speed_mps) return std::nullopt;
  double chi2 = 0.0;
  for (const HistoryPoint& p : points) {
    const double e = p.range_rate_mps - p.sight.dot(velocity);
    chi2 += e * e / p.range_rate_variance;
  }
  const double scale = std::max(1.0, chi2 / std::max(1.0, static_cast<double>(points.size()) - 2.0));
  return DopplerHeading{
      {std::atan2(velocity.y(), velocity.x()), direction_variance(velocity, scale * covariance, turn_mps)}, speed};
}

std::optional<DopplerHeading> interval_search(std::span<const HistoryPoint> points, double near_rad,
                                              const DopplerParameters& parameters, double turn_mps) {
  if (points.size() < parameters.least_points) return std::nullopt;
  constexpr std::size_t kSteps = 33;
  std::array<double, kSteps> chi2{}, speed{};
  const auto direction = [&](std::size_t k) {
    return near_rad + parameters.interval_rad * (2.0 * static_cast<double>(k) / static_cast<double>(kSteps - 1) - 1.0);
  };
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kSteps; ++k) {
    const Eigen::Vector2d e(std::cos(direction(k)), std::sin(direction(k)));
    // v = ṙ/cos has the deviation σ/cos: weights cos²/σ².
    double weights = 0.0, sum = 0.0;
    for (const HistoryPoint& p : points) {
      const double cosine = p.sight.dot(e);
      weights += cosine * cosine / p.range_rate_variance;
      sum += cosine * p.range_rate_mps / p.range_rate_variance;
    }
    if (weights <= 0.0) return std::nullopt;
    speed[k] = sum / weights;
    for (const HistoryPoint& p : points) {
      const double deviation = p.range_rate_mps - speed[k] * p.sight.dot(e);
      chi2[k] += std::min(deviation * deviation / p.range_rate_variance, parameters.outlier_chi2);
    }
    if (chi2[k] < least) {
      least = chi2[k];
      best = k;
    }
  }
  if (speed[best] < parameters.least_speed_mps) return std::nullopt;
  const double scale = std::max(1.0, least / std::max(1.0, static_cast<double>(points.size()) - 2.0));
  double weights = 0.0, mean = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double weight = std::exp(-0.5 * (chi2[k] - least) / scale), off = direction(k) - direction(best);
    weights += weight;
    mean += weight * off;
    squares += weight * off * off;
  }
  mean /= weights;
  const double step = 2.0 * parameters.interval_rad / static_cast<double>(kSteps - 1);
  const double turn_rad = turn_mps / speed[best];
  return DopplerHeading{{geometry::wrap_angle(direction(best) + mean),
                         squares / weights - mean * mean + step * step / 12.0 + turn_rad * turn_rad},
                        speed[best]};
}

}  // namespace boresight::tracking::classical
