#include "services/alignment_estimator/core/plausibility/velocity_window.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "services/alignment_estimator/core/published/draw.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"

namespace boresight::alignment::plausibility {

namespace {

/// Sectors of 10°: traffic fills few of them, the stationary world many.
constexpr std::size_t kSectors = 36;
constexpr std::size_t kLeastDetections = 12, kLeastSectors = 3;
/// Pairs of detections tried. With half of the detections stationary, all fail once in 10⁵ windows.
constexpr int kPairs = 40;
/// Smallest sine of the angle between the two directions of a pair.
constexpr double kLeastSine = 0.1;
constexpr double kHighestSpeed_mps = 80.0;
/// Change of the velocity in a window, elevation and other errors that the fit does not model (choice).
constexpr double kModelStd_mps = 0.15;
/// Tukey's constant, in stds.
constexpr double kGateStds = 3.0;
constexpr double kWidestGate_mps = 2.0;
/// A reflector gives detections in all scans of a window, so that they are not independent.
constexpr double kDetectionsPerReflector = 6.0;
constexpr float kStanding_mps = 0.2F;
constexpr int kPasses = 5;
/// The gate of the first pass is this times the last one's.
constexpr double kFirstGate = 2.5;

/// To the nearest whole number, for less than 2²²: adding 1.5·2²³ leaves no bits for a fraction. Faster than the
/// library's function, which compilers do not vectorise.
inline float rounded(float value) {
  constexpr float kNoFraction = 12582912.0F;
  return (value + kNoFraction) - kNoFraction;
}

}  // namespace

void VelocityWindow::add(const ScanDetections& scan, std::size_t most) {
  if (count_ == 0) azimuth_variance_ = range_rate_variance_ = 0.0;
  interval_mps_ = static_cast<float>(scan.ambiguity_mps);
  per_interval_ = scan.ambiguity_mps > 0.0 ? static_cast<float>(1.0 / scan.ambiguity_mps) : 0.0F;
  const std::size_t taken = std::min({scan.count, most, kCapacity - count_});
  for (std::size_t n = 0; n < taken; ++n) {
    const std::size_t i = n * scan.count / taken, k = count_++;
    const double azimuth = scan.azimuth_rad[i], level = std::cos(scan.elevation_rad[i]);
    x_[k] = static_cast<float>(level * std::cos(azimuth));
    y_[k] = static_cast<float>(level * std::sin(azimuth));
    range_rate_[k] = static_cast<float>(scan.range_rate_mps[i]);
    const double sector = std::floor((azimuth / (2.0 * M_PI) + 0.5) * static_cast<double>(kSectors));
    sector_[k] = static_cast<std::uint8_t>(std::clamp(sector, 0.0, static_cast<double>(kSectors - 1)));
    azimuth_variance_ += square(scan.azimuth_std_rad[i]);
    range_rate_variance_ += square(scan.range_rate_std_mps[i]);
  }
}

VelocityFit VelocityWindow::fit(std::span<const Eigen::Vector2d> starts) {
  VelocityFit fit;
  if (count_ < kLeastDetections) return fit;
  weigh();
  if (sectors_ < kLeastSectors) return fit;
  float best = -1.0F;
  const auto consider = [&](const Eigen::Vector2d& velocity) {
    const float of_velocity = score(velocity, gate(velocity));
    if (of_velocity <= best) return;
    best = of_velocity;
    fit.velocity_mps = velocity;
  };
  // A start is the velocity of a nominal mounting: a few passes find the actual one.
  for (Eigen::Vector2d start : starts) {
    refine(start);
    consider(start);
  }
  for (int i = 0; i < kPairs; ++i) {
    bool usable = false;
    const Eigen::Vector2d velocity = draw_pair(usable);
    if (usable) consider(velocity);
  }
  refine(fit.velocity_mps);
  judge(fit);
  return fit;
}

void VelocityWindow::weigh() {
  std::array<unsigned, kSectors> detections{};
  for (std::size_t i = 0; i < count_; ++i) ++detections[sector_[i]];
  sectors_ =
      static_cast<std::size_t>(std::count_if(detections.begin(), detections.end(), [](auto n) { return n > 0; }));
  // A sector counts once, however many detections one vehicle gives in it; a single detection counts less.
  const double least = 0.5 * static_cast<double>(count_) / static_cast<double>(sectors_);
  double sum = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double weight = 1.0 / std::max(least, static_cast<double>(detections[sector_[i]]));
    weight_[i] = static_cast<float>(weight);
    sum += weight;
  }
  for (std::size_t i = 0; i < count_; ++i) weight_[i] /= static_cast<float>(sum);
}

float VelocityWindow::gate(const Eigen::Vector2d& velocity) const {
  const double n = static_cast<double>(count_);
  // Half of the velocity's square is across a direction, in the mean over directions.
  const double variance =
      square(kModelStd_mps) + (range_rate_variance_ + 0.5 * velocity.squaredNorm() * azimuth_variance_) / n;
  return static_cast<float>(std::min(kGateStds * std::sqrt(variance), kWidestGate_mps));
}

float VelocityWindow::score(const Eigen::Vector2d& velocity, float gate) const {
  const auto vx = static_cast<float>(velocity.x()), vy = static_cast<float>(velocity.y());
  const float per_gate = 1.0F / gate;
  float sum = 0.0F;
  for (std::size_t i = 0; i < count_; ++i) {
    float residual = range_rate_[i] + x_[i] * vx + y_[i] * vy;
    residual -= interval_mps_ * rounded(residual * per_interval_);
    const float in_gates = residual * per_gate, rest = std::max(0.0F, 1.0F - in_gates * in_gates);
    sum += weight_[i] * rest * rest;
  }
  return sum;
}

Eigen::Vector2d VelocityWindow::draw_pair(bool& usable) {
  published::Draw draw(random_);
  random_ = draw.next();
  const std::size_t i = draw.below(count_), j = draw.below(count_);
  double first = static_cast<double>(range_rate_[i]), second = static_cast<double>(range_rate_[j]);
  if (interval_mps_ > 0.0F) {
    first += static_cast<double>(interval_mps_) * (static_cast<double>(draw.below(3)) - 1.0);
    second += static_cast<double>(interval_mps_) * (static_cast<double>(draw.below(3)) - 1.0);
  }
  const auto xi = static_cast<double>(x_[i]), yi = static_cast<double>(y_[i]);
  const auto xj = static_cast<double>(x_[j]), yj = static_cast<double>(y_[j]);
  const double sine = xi * yj - xj * yi;
  if (std::abs(sine) < kLeastSine) return {};
  const Eigen::Vector2d velocity{-(yj * first - yi * second) / sine, -(xi * second - xj * first) / sine};
  usable = velocity.norm() < kHighestSpeed_mps;
  return velocity;
}

void VelocityWindow::refine(Eigen::Vector2d& velocity) const {
  const double shrink = std::pow(kFirstGate, -1.0 / static_cast<double>(kPasses - 1));
  double wider = kFirstGate;
  for (int pass = 0; pass < kPasses; ++pass, wider *= shrink) {
    const float per_gate = 1.0F / (gate(velocity) * static_cast<float>(wider));
    const auto vx = static_cast<float>(velocity.x()), vy = static_cast<float>(velocity.y());
    float xx = 1e-6F, xy = 0.0F, yy = 1e-6F, rx = 0.0F, ry = 0.0F;
    for (std::size_t i = 0; i < count_; ++i) {
      float residual = range_rate_[i] + x_[i] * vx + y_[i] * vy;
      residual -= interval_mps_ * rounded(residual * per_interval_);
      const float in_gates = residual * per_gate, rest = std::max(0.0F, 1.0F - in_gates * in_gates);
      const float weight = weight_[i] * rest * rest;
      xx += weight * x_[i] * x_[i];
      xy += weight * x_[i] * y_[i];
      yy += weight * y_[i] * y_[i];
      rx += weight * x_[i] * residual;
      ry += weight * y_[i] * residual;
    }
    const float determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-9F)) return;
    velocity -= Eigen::Vector2d{static_cast<double>((yy * rx - xy * ry) / determinant),
                                static_cast<double>((xx * ry - xy * rx) / determinant)};
  }
}

void VelocityWindow::judge(VelocityFit& fit) const {
  const float limit = gate(fit.velocity_mps);
  const auto vx = static_cast<float>(fit.velocity_mps.x()), vy = static_cast<float>(fit.velocity_mps.y());
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  double squares = 0.0, inliers = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    float residual = range_rate_[i] + x_[i] * vx + y_[i] * vy;
    residual -= interval_mps_ * rounded(residual * per_interval_);
    if (std::abs(residual) < limit) {
      const Eigen::Vector2d u{static_cast<double>(x_[i]), static_cast<double>(y_[i])};
      information += u * u.transpose();
      squares += static_cast<double>(residual * residual);
      inliers += 1.0;
      fit.share += static_cast<double>(weight_[i]);
    } else if (std::abs(range_rate_[i]) < kStanding_mps) {
      fit.standing_share += static_cast<double>(weight_[i]);
    }
  }
  const double determinant = information.determinant();
  if (!(inliers >= static_cast<double>(kLeastDetections) / 2.0 && determinant > 1e-3 * inliers)) return;
  const double variance = std::max(squares / inliers, square(0.05));
  fit.covariance = information.inverse() * variance * kDetectionsPerReflector;
  fit.valid = fit.velocity_mps.allFinite() && fit.velocity_mps.norm() < kHighestSpeed_mps;
}

}  // namespace boresight::alignment::plausibility
