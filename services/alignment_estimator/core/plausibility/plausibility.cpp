#include "services/alignment_estimator/core/plausibility/plausibility.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::alignment::plausibility {

namespace {

/// A sensor that moves slower does not tell its direction.
constexpr double kSlowestSensor_mps = 3.0, kSlowestPrediction_mps = 1.0;
/// Range of velocities that traffic, taken for the stationary world, may show.
constexpr double kTrafficSpeed_mps = 60.0;
/// Up to this speed a vehicle may reverse without a sign of the speed signal; cosine beyond which it then seems to.
constexpr double kFastestReverse_mps = 10.0, kReverse = -0.7;
/// What the hypotheses do not model: azimuth errors and side slip, yaw-rate bias, late stamps, noise of the speed.
constexpr double kYawTolerance_rad = 0.4 * kRadiansPerDegree, kYawRateTolerance_radps = 0.2 * kRadiansPerDegree;
constexpr double kStampTolerance_s = 0.08;
constexpr double kScaleTolerance = 0.01, kSpeedTolerance_mps = 0.1;
/// Lateral acceleration of cars.
constexpr double kMostLateral_mps2 = 10.0;
/// One window counts for at most this, as logarithm: the next one shows the same scene. Smaller differences than the
/// tolerance say nothing, since errors of the model persist.
constexpr double kMostPerWindow = 3.0, kTolerancePerWindow = 0.7;
/// Limit of the logarithm, so that later windows can change it.
constexpr double kLeastLog = -40.0;
constexpr double kTrafficShare = 0.05;

double angle_of(const Eigen::Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// Covariance of argument and logarithm of the size.
Eigen::Matrix2d polar(const Eigen::Matrix2d& covariance, const Eigen::Vector2d& v) {
  const double squared = v.squaredNorm();
  Eigen::Matrix2d j;
  j << -v.y() / squared, v.x() / squared, v.x() / squared, v.y() / squared;
  return j * covariance * j.transpose();
}

}  // namespace

Plausibility::Plausibility(const VehicleConfig& vehicle, const PlausibilityConfig& config)
    : config_(config),
      radars_(vehicle.radars.size()),
      copies_(vehicle.radars.size()),
      speed_signal_(vehicle.radars.size()) {
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    Radar& radar = radars_[i];
    const RadarConfig& of = vehicle.radars[i];
    radar.id = of.id;
    radar.position_m = {of.mounting_pose.position_m[0], of.mounting_pose.position_m[1]};
    radar.to_sensor = geometry::sensor_to_vehicle(of.mounting_pose, 0.0, 0.0, 0.0).transpose().topLeftCorner<2, 2>();
    if (std::abs(radar.to_sensor.determinant()) > 0.1) radar.to_vehicle = radar.to_sensor.inverse();
    const double scans = std::max(1.0, config.window_s / std::max(1e-3, of.cycle_time_s));
    radar.most_per_scan = static_cast<std::size_t>(std::ceil(static_cast<double>(VelocityWindow::kCapacity) / scans));
    radar.hypotheses.resize(kOther + radars_.size());
    for (std::size_t h = 0; h < radar.hypotheses.size(); ++h) radar.hypotheses[h] = Hypothesis(h == kNominalYaw);
  }
}

void Plausibility::add(std::size_t index, const ScanDetections& scan, const EgoSample& ego) {
  if (!config_.enabled) return;
  Radar& radar = radars_[index];
  const double time_s = seconds(scan.time_ns);
  const bool moves = ego.valid && !ego.stale;
  speed_signal_.add_signal(ego, time_s);
  const bool has_begun = radar.motion.scans > 0.0;
  // A restarted recording, or a pause.
  const auto window_ns = static_cast<std::int64_t>(config_.window_s * 1e9);
  if (has_begun && (scan.time_ns < radar.last_ns || scan.time_ns - radar.last_ns > 2 * window_ns)) {
    radar.window.clear();
    radar.motion = {};
  } else if (has_begun && scan.time_ns - radar.start_ns >= window_ns) {
    close(index, time_s);
  }
  if (radar.motion.scans == 0.0) radar.start_ns = scan.time_ns;
  radar.last_ns = scan.time_ns;
  const bool is_moving = (moves && std::abs(ego.speed_mps) > kSlowestSensor_mps);
  if (!copies_.add(index, scan, is_moving)) radar.window.add(scan, radar.most_per_scan);
  Motion& motion = radar.motion;
  motion.scans += 1.0;
  if (!moves) return;
  if (motion.valid == 0.0) {
    motion.first_speed_mps = ego.speed_mps;
    motion.first_yaw_rate_radps = ego.yaw_rate_radps;
  }
  motion.last_speed_mps = ego.speed_mps;
  motion.last_yaw_rate_radps = ego.yaw_rate_radps;
  motion.speed_mps += ego.speed_mps;
  motion.yaw_rate_radps += ego.yaw_rate_radps;
  motion.valid += 1.0;
}

void Plausibility::add_rejected(std::size_t index, const ScanDetections& scan) {
  if (!config_.enabled) return;
  static_cast<void>(copies_.add(index, scan, true));
  decide(index, seconds(scan.time_ns));
}

void Plausibility::close(std::size_t index, double time_s) {
  Radar& radar = radars_[index];
  Motion& motion = radar.motion;
  const double elapsed_s = std::max(1e-3, seconds(radar.last_ns - radar.start_ns));
  if (motion.valid > 0.0) {
    motion.speed_mps /= motion.valid;
    motion.yaw_rate_radps /= motion.valid;
  }
  const Eigen::Vector2d nominal =
      radar.to_sensor * Eigen::Vector2d(motion.speed_mps - motion.yaw_rate_radps * radar.position_m[1],
                                        motion.yaw_rate_radps * radar.position_m[0]);
  const std::array<Eigen::Vector2d, 6> starts{
      Eigen::Vector2d::Zero(), nominal,           -nominal, {nominal.x(), -nominal.y()},
      nominal / kKmhPerMps,    radar.velocity_mps};
  const VelocityFit fit = radar.window.fit(starts);
  if (fit.valid) {
    radar.velocity_mps = fit.velocity_mps;
    speed_signal_.add_velocity(index, fit, radar.to_vehicle * fit.velocity_mps, time_s);
    const bool is_known = motion.valid > 0.8 * motion.scans;
    if (is_known && fit.share >= config_.least_share) weigh(index, fit, elapsed_s);
  }
  radar.window.clear();
  radar.motion = {};
  decide(index, time_s);
}

void Plausibility::weigh(std::size_t index, const VelocityFit& fit, double seconds) {
  Radar& radar = radars_[index];
  const double speed_mps = fit.velocity_mps.norm();
  if (speed_mps < kSlowestSensor_mps) return;
  const Eigen::Vector2d as_mounted = radar.to_vehicle * fit.velocity_mps;
  const double along = as_mounted.x() * (radar.motion.speed_mps >= 0.0 ? 1.0 : -1.0);
  if (speed_mps < kFastestReverse_mps && along < kReverse * as_mounted.norm()) return;
  const double background = square(speed_mps / kTrafficSpeed_mps) / M_PI;
  std::array<double, kMostHypotheses> logs;
  const std::size_t count = radar.hypotheses.size();
  for (std::size_t h = 0; h < count; ++h) {
    logs[h] = h == kOther + index ? 2.0 * kLeastLog : add_deviation(radar, h, fit, seconds, background);
  }
  const double best = *std::max_element(logs.begin(), logs.begin() + static_cast<std::ptrdiff_t>(count));
  double largest = 2.0 * kLeastLog;
  for (std::size_t h = 0; h < count; ++h) {
    radar.logs[h] -= std::clamp(best - logs[h] - kTolerancePerWindow, 0.0, kMostPerWindow);
    if (h != kOther + index) largest = std::max(largest, radar.logs[h]);
  }
  for (std::size_t h = 0; h < count; ++h) radar.logs[h] = std::max(kLeastLog, radar.logs[h] - largest);
  radar.logs[kOther + index] = kLeastLog;
  ++radar.windows;
  add_limits(radar);
}

double Plausibility::add_deviation(Radar& radar, std::size_t h, const VelocityFit& fit, double seconds,
                                   double background) {
  const Radar& mounted = h >= kOther ? radars_[h - kOther] : radar;
  const double speed_factor = h == kKmh ? 1.0 / kKmhPerMps : h == kMph ? 1.0 / kMphPerMps : 1.0;
  const double yaw_rate_factor = h == kYawRate ? -1.0 : h == kDegrees ? kRadiansPerDegree : 1.0;
  const Motion& motion = radar.motion;
  const double speed_mps = speed_factor * motion.speed_mps, yaw_rate = yaw_rate_factor * motion.yaw_rate_radps;
  const double x_m = mounted.position_m[0], y_m = mounted.position_m[1];
  const Eigen::Vector2d predicted(speed_mps - yaw_rate * y_m, yaw_rate * x_m);
  const double size_mps = predicted.norm();
  if (size_mps < kSlowestPrediction_mps) return std::log(kTrafficShare * background);

  Eigen::Matrix2d to_vehicle = mounted.to_vehicle;
  if (h == kAzimuth) to_vehicle.col(1) *= -1.0;
  if (h == kRangeRate) to_vehicle *= -1.0;
  const Eigen::Vector2d measured = to_vehicle * fit.velocity_mps;
  Deviation deviation;
  deviation.yaw_rad = geometry::wrap_angle(angle_of(predicted) - angle_of(measured));
  deviation.scale = std::log(measured.norm() / size_mps);
  deviation.slip_mps2 = std::clamp(speed_mps * yaw_rate, -kMostLateral_mps2, kMostLateral_mps2);
  const double yaw_change =
      yaw_rate_factor * (motion.last_yaw_rate_radps - motion.first_yaw_rate_radps) / seconds * kStampTolerance_s;
  const double speed_change =
      speed_factor * (motion.last_speed_mps - motion.first_speed_mps) / seconds * kStampTolerance_s;
  deviation.covariance = polar(to_vehicle * fit.covariance * to_vehicle.transpose(), measured);
  deviation.covariance(0, 0) +=
      square(kYawTolerance_rad) + (square(yaw_change) + square(kYawRateTolerance_radps)) * square(x_m / size_mps);
  deviation.covariance(1, 1) +=
      square(kScaleTolerance) + (square(kSpeedTolerance_mps) + square(speed_change)) / square(size_mps);
  return radar.hypotheses[h].add(deviation, background);
}

}  // namespace boresight::alignment::plausibility
