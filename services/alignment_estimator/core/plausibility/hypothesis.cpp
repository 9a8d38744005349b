#include "services/alignment_estimator/core/plausibility/hypothesis.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::alignment::plausibility {

namespace {

// Errors before any data; mounting and scale as in the estimator's priors. The slip coefficient of cars is 0.003…0.006.
constexpr double kYawStd_rad = 4.0 * kRadiansPerDegree;
constexpr double kScaleStd = 0.03;
constexpr double kSlip_radps2pm = 0.0045, kSlipStd_radps2pm = 0.002;
/// And no car's differs from that by more: a wrong yaw rate would look like such a slip at constant speed.
constexpr double kMostSlip_radps2pm = 3.0 * kSlipStd_radps2pm;
// Slow errors that the filter does not model: change per window (choice).
constexpr double kYawWalk_rad = 0.1 * kRadiansPerDegree, kScaleWalk = 0.002;
/// Probability that the velocity is that of traffic, and that the errors have changed suddenly.
constexpr double kBackgroundShare = 0.05, kRestartShare = 0.001;
constexpr double kSmallestLog = -60.0;

double log_normal(const Eigen::Vector2d& difference, const Eigen::Matrix2d& covariance) {
  const double determinant = covariance.determinant();
  if (!(determinant > 0.0)) return kSmallestLog;
  return std::max(kSmallestLog, -0.5 * difference.dot(covariance.inverse() * difference) - 0.5 * std::log(determinant) -
                                    std::log(2.0 * M_PI));
}

Eigen::Matrix2d predicted(const Eigen::Matrix3d& covariance, const Deviation& deviation) {
  Eigen::Matrix<double, 2, 3> h;
  h << 1.0, 0.0, deviation.slip_mps2, 0.0, 1.0, 0.0;
  return h * covariance * h.transpose() + deviation.covariance;
}

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

}  // namespace

void Hypothesis::restart() {
  mean_ << 0.0, 0.0, kSlip_radps2pm;
  covariance_ = Eigen::Vector3d(square(kYawStd_rad), square(kScaleStd), square(kSlipStd_radps2pm)).asDiagonal();
  has_yaw_ = false;
}

Eigen::Vector2d Hypothesis::innovation(const Deviation& deviation, const Eigen::Vector3d& mean) const {
  return {geometry::wrap_angle(deviation.yaw_rad - mean(0) - deviation.slip_mps2 * mean(2)), deviation.scale - mean(1)};
}

double Hypothesis::add(const Deviation& deviation, double background) {
  covariance_(0, 0) += square(kYawWalk_rad);
  covariance_(1, 1) += square(kScaleWalk);
  Hypothesis fresh(any_yaw_);
  double anew;
  if (any_yaw_) {
    const double variance = square(kScaleStd) + deviation.covariance(1, 1);
    anew = -0.5 * square(deviation.scale) / variance - 0.5 * std::log(2.0 * M_PI * variance) - std::log(2.0 * M_PI);
  } else {
    anew = log_normal(innovation(deviation, fresh.mean_), predicted(fresh.covariance_, deviation));
  }
  const double as_before =
      any_yaw_ && !has_yaw_ ? anew : log_normal(innovation(deviation, mean_), predicted(covariance_, deviation));
  const double of_state = (1.0 - kBackgroundShare) * std::exp(as_before);
  const double of_restart = kRestartShare * std::exp(anew), of_traffic = kBackgroundShare * background;
  if (of_restart > of_state + of_traffic) {
    restart();
    learn(deviation);
  } else if (of_state > of_traffic) {
    learn(deviation);
  }
  return std::log(of_state + of_restart + of_traffic);
}

void Hypothesis::learn(const Deviation& deviation) {
  if (any_yaw_ && !has_yaw_) {
    mean_(0) = geometry::wrap_angle(deviation.yaw_rad - deviation.slip_mps2 * mean_(2));
    // The yaw is not known yet, so that the deviation decides it alone.
    covariance_(0, 0) = square(2.0 * M_PI);
    has_yaw_ = true;
  }
  Eigen::Matrix<double, 2, 3> h;
  h << 1.0, 0.0, deviation.slip_mps2, 0.0, 1.0, 0.0;
  const Eigen::Matrix<double, 3, 2> gain = covariance_ * h.transpose() * predicted(covariance_, deviation).inverse();
  mean_ += gain * innovation(deviation, mean_);
  mean_(0) = geometry::wrap_angle(mean_(0));
  covariance_ = (covariance_ - gain * h * covariance_).eval();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

double Hypothesis::log_within(double low_rad, double high_rad) const {
  const auto within = [](double limit, double mean, double variance) {
    const double std = std::sqrt(variance);
    return normal_cdf((limit - mean) / std) - normal_cdf((-limit - mean) / std);
  };
  const double slip = within(kMostSlip_radps2pm, mean_(2) - kSlip_radps2pm, covariance_(2, 2));
  double before = within(high_rad, 0.0, square(kYawStd_rad)), now = within(high_rad, mean_(0), covariance_(0, 0));
  if (any_yaw_) {
    before = (high_rad - low_rad) / M_PI;
    now = has_yaw_ ? now - within(low_rad, mean_(0), covariance_(0, 0)) : before;
  }
  return std::max(kSmallestLog, std::log(std::max(slip * now, 1e-300) / before));
}

}  // namespace boresight::alignment::plausibility
