#include "services/detection_corrector/core/range_rate_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace boresight::corrector {

namespace {

bool is_usable(const Innovation& i) {
  return std::isfinite(i.value_mps) && i.direction.allFinite() && std::isfinite(i.stated_variance_m2ps2) &&
         i.stated_variance_m2ps2 > 0.0 && std::isfinite(i.angular_variance_m2ps2) && i.angular_variance_m2ps2 >= 0.0;
}

double normal_density(double value, double variance) {
  return std::exp(-0.5 * value * value / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
}

/// Falls with the square only: however large a range rate is, the stationary reflectors' variance need not explain it.
double cauchy_density(double value, double width) {
  return std::numbers::inv_pi * width / (width * width + value * value);
}

/// The error common to a scan: mean and covariance.
struct CommonError {
  Eigen::Vector3d mean_mps = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance;

  /// Variance of direction·δ.
  [[nodiscard]] double spread(const Eigen::Vector3d& direction) const { return direction.dot(covariance * direction); }
};

}  // namespace

void RangeRateNoise::set_prior(double scale) {
  prior_factor_ = std::isfinite(scale) && scale > 0.0 ? scale * scale : 1.0;
  weigh();
}

void RangeRateNoise::weigh() {
  const double prior = config_.prior_detections;
  factor_ = std::clamp((prior * prior_factor_ + sum_) / (prior + weight_), config_.least_scale * config_.least_scale,
                       config_.most_scale * config_.most_scale);
}

void RangeRateNoise::learn(std::span<const Innovation> scan, const Eigen::Matrix3d& common, std::int64_t time_ns) {
  if (!common.allFinite()) return;
  const double age_s = has_time_ ? std::max(0.0, static_cast<double>(time_ns - time_ns_) * 1e-9) : 0.0;
  has_time_ = true;
  time_ns_ = time_ns;
  const double keep = std::exp(-age_s / config_.time_constant_s);
  for (double* const sum : {&weight_, &sum_, &seen_, &others_}) *sum *= keep;

  CommonError error{Eigen::Vector3d::Zero(), common};
  const auto own_variance = [&](const Innovation& i) {
    return factor_ * i.stated_variance_m2ps2 + i.angular_variance_m2ps2;
  };
  // Equation (C11)
  const auto stationary_probability = [&](const Innovation& i) {
    const double own = own_variance(i), deviation = i.value_mps - i.direction.dot(error.mean_mps);
    const double stationary = (1.0 - other_share_) * normal_density(deviation, own + error.spread(i.direction));
    const double other = other_share_ * cauchy_density(i.value_mps, config_.other_width_mps);
    return stationary / (stationary + other);
  };

  // Equation (C12)
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const Innovation& i : scan) {
    if (!is_usable(i)) continue;
    const double weight = stationary_probability(i) / own_variance(i);
    information += weight * i.direction * i.direction.transpose();
    weighted += weight * i.value_mps * i.direction;
  }
  const Eigen::Matrix3d posterior = (Eigen::Matrix3d::Identity() + common * information).inverse() * common;
  if (!posterior.allFinite()) return;
  error = {posterior * weighted, posterior};

  // Equation (C13): the expected square of the detection's own error, with the weight of its Fisher information on s².
  for (const Innovation& i : scan) {
    if (!is_usable(i)) continue;
    const double deviation = i.value_mps - i.direction.dot(error.mean_mps);
    const double share = factor_ * i.stated_variance_m2ps2 / own_variance(i);
    const double probability = stationary_probability(i), weight = probability * share * share;
    const double squared = deviation * deviation + error.spread(i.direction) - i.angular_variance_m2ps2;
    seen_ += 1.0;
    others_ += 1.0 - probability;
    weight_ += weight;
    sum_ += weight * squared / i.stated_variance_m2ps2;
  }
  other_share_ = (config_.prior_detections * config_.other_share + others_) / (config_.prior_detections + seen_);
  weigh();
}

}  // namespace boresight::corrector
