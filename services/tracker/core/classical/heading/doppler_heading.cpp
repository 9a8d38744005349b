#include "services/tracker/core/classical/heading/doppler_heading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking::classical {

namespace {

/// Variance of the direction of a velocity, with what an unknown turn rate adds across it.
double direction_variance(const Eigen::Vector2d& velocity, const Eigen::Matrix2d& covariance, double turn_mps) {
  const double speed2 = velocity.squaredNorm();
  const Eigen::Vector2d across(-velocity.y(), velocity.x());
  return (across.dot(covariance * across) / speed2 + turn_mps * turn_mps) / speed2;
}

constexpr std::size_t kLevels = 3;

/// Squared deviations of the range rates for directions at equal steps of an interval, and their peak.
class IntervalSearch {
 public:
  IntervalSearch(std::span<const HistoryPoint> points, double centre_rad, double half_rad, double outlier_chi2)
      : first_rad_(centre_rad - half_rad), step_rad_(2.0 * half_rad / static_cast<double>(kSteps - 1)) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kSteps; ++k) {
      const Eigen::Vector2d along(std::cos(rad(k)), std::sin(rad(k))), across(-along.y(), along.x());
      // The true direction is anywhere within half a step.
      const auto variance_of = [&](const HistoryPoint& p, double speed_mps) {
        const double by_step = speed_mps * p.sight.dot(across) * 0.5 * step_rad_;
        return p.range_rate_variance + by_step * by_step / 3.0;
      };
      // v = ṙ/cos has the deviation σ/cos: weights cos²/σ². The second fit passes over what the first one does not
      // hold.
      for (const bool is_trimmed : {false, true}) {
        double weights = 0.0, sum = 0.0;
        for (const HistoryPoint& p : points) {
          const double cosine = p.sight.dot(along), deviation = p.range_rate_mps - speed_mps_[k] * cosine;
          const double variance = variance_of(p, speed_mps_[k]);
          if (is_trimmed && deviation * deviation > outlier_chi2 * variance) continue;
          weights += cosine * cosine / variance;
          sum += cosine * p.range_rate_mps / variance;
        }
        if (weights > 0.0) speed_mps_[k] = sum / weights;
      }
      for (const HistoryPoint& p : points) {
        const double deviation = p.range_rate_mps - speed_mps_[k] * p.sight.dot(along);
        const double variance = variance_of(p, speed_mps_[k]);
        chi2_[k] +=
            std::min(deviation * deviation / variance, outlier_chi2) + std::log(variance / p.range_rate_variance);
      }
      if (chi2_[k] >= least) continue;
      least = chi2_[k];
      best_ = k;
    }
    const double scale = std::max(1.0, least / std::max(1.0, static_cast<double>(points.size()) - 2.0));
    double weights = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < kSteps; ++k) {
      const double weight = std::exp(-0.5 * (chi2_[k] - least) / scale), off = rad(k) - rad(best_);
      weights += weight;
      off_rad_ += weight * off;
      squares += weight * off * off;
    }
    off_rad_ /= weights;
    variance_rad2_ = squares / weights - off_rad_ * off_rad_ + step_rad_ * step_rad_ / 12.0;
  }

  [[nodiscard]] double step_rad() const { return step_rad_; }
  [[nodiscard]] double best_rad() const { return rad(best_); }
  [[nodiscard]] double mean_rad() const { return rad(best_) + off_rad_; }
  [[nodiscard]] double variance_rad2() const { return variance_rad2_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_[best_]; }

 private:
  static constexpr std::size_t kSteps = 17;
  [[nodiscard]] double rad(std::size_t k) const { return first_rad_ + static_cast<double>(k) * step_rad_; }

  double first_rad_, step_rad_;
  std::array<double, kSteps> chi2_{}, speed_mps_{};
  std::size_t best_ = 0;
  double off_rad_ = 0.0, variance_rad2_ = 0.0;
};

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
  double centre_rad = near_rad, half_rad = parameters.interval_rad;
  std::optional<DopplerHeading> found;
  // From the whole interval to a step of it, so that a narrow minimum is not passed over. The last level that holds the
  // whole peak states the variance.
  for (std::size_t level = 0; level < kLevels; ++level) {
    const IntervalSearch search(points, centre_rad, half_rad, parameters.outlier_chi2);
    const double speed = search.speed_mps();
    if (speed < parameters.least_speed_mps) return level == 0 ? std::nullopt : found;
    const double turn_rad = turn_mps / speed, variance = search.variance_rad2();
    const bool holds_peak = level == 0 || variance < half_rad * half_rad / 9.0;
    const double known = holds_peak ? variance + turn_rad * turn_rad : found->heading.variance_rad2;
    found = DopplerHeading{{geometry::wrap_angle(search.mean_rad()), known}, speed};
    centre_rad = search.best_rad();
    half_rad = 1.5 * search.step_rad();
  }
  return found;
}

}  // namespace boresight::tracking::classical
