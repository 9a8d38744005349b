#include "services/alignment_estimator/core/batch_calibration/gate.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "services/alignment_estimator/core/batch_calibration/joint.hpp"

namespace boresight::alignment::batch_calibration {

namespace {

constexpr double kMadToStd = 1.4826;
constexpr double kTukey = 4.685;  // 95 % efficient for Gaussian residuals
constexpr int kRounds = 20;

bool usable(const Detection& d, bool has_elevation, double min_speed_mps) {
  return std::isfinite(d.azimuth_rad) && (!has_elevation || std::isfinite(d.elevation_rad)) &&
         std::isfinite(d.range_rate_mps) && std::isfinite(d.yaw_rate_radps) && std::isfinite(d.speed_mps) &&
         d.speed_mps >= min_speed_mps;
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Centre {
  double median, std;
};

Centre centre_of(const std::vector<double>& residuals) {
  std::vector<double> values = residuals;
  const double m = median(values);
  for (double& v : values) v = std::abs(v - m);
  return {m, kMadToStd * median(values)};
}

std::vector<double> residuals_of(const Recording& radar, const Eigen::Vector4d& b) {
  std::vector<double> residuals;
  residuals.reserve(radar.detections.size());
  for (const Detection& d : radar.detections) {
    residuals.push_back(
        published::PlanarModel(radar.nominal, b, d.speed_mps, d.yaw_rate_radps).value(d.azimuth_rad, d.elevation_rad) -
        d.range_rate_mps);
  }
  return residuals;
}

/// k_v and the yaw of each radar; pitch and roll stay 0.
Eigen::VectorXd robust_yaw_fit(std::span<const Recording> radars, double floor_mps,
                               const std::function<void(double)>& progress) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(first_angle(radars.size()));
  x(0) = 1.0;
  const auto n = static_cast<Eigen::Index>(radars.size());
  for (int round = 0; round < kRounds; ++round) {
    if (progress) progress(static_cast<double>(round) / kRounds);
    Eigen::MatrixXd information = 1e-9 * Eigen::MatrixXd::Identity(n + 1, n + 1);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + 1);
    for (Eigen::Index r = 0; r < n; ++r) {
      const Recording& radar = radars[static_cast<std::size_t>(r)];
      const Eigen::Vector4d b = of_radar(x, static_cast<std::size_t>(r));
      const Centre centre = centre_of(residuals_of(radar, b));
      // The first rounds use a wider gate, since the fit has not converged yet.
      const double limit = kTukey * std::max(centre.std, floor_mps) * (round < 5 ? 2.0 : 1.0);
      for (const Detection& d : radar.detections) {
        const published::RangeRate p =
            published::PlanarModel(radar.nominal, b, d.speed_mps, d.yaw_rate_radps)(d.azimuth_rad, d.elevation_rad);
        const double residual = p.value_mps - d.range_rate_mps;
        const double q = 1.0 - residual * residual / (limit * limit);
        if (q <= 0.0) continue;
        const Eigen::Vector2d g = p.gradient.head<2>();
        const double weight = q * q;
        information(0, 0) += weight * g(0) * g(0);
        information(0, r + 1) += weight * g(0) * g(1);
        information(r + 1, 0) += weight * g(0) * g(1);
        information(r + 1, r + 1) += weight * g(1) * g(1);
        right(0) -= weight * residual * g(0);
        right(r + 1) -= weight * residual * g(1);
      }
    }
    const Eigen::VectorXd step = information.ldlt().solve(right);
    if (!step.allFinite()) break;
    x(0) = std::clamp(x(0) + step(0), 0.8, 1.2);
    for (Eigen::Index r = 0; r < n; ++r) {
      double& yaw = x(first_angle(static_cast<std::size_t>(r)));
      yaw = std::clamp(yaw + step(r + 1), -0.35, 0.35);
    }
    if (step.cwiseAbs().maxCoeff() < 1e-7) break;
  }
  return x;
}

}  // namespace

std::vector<Recording> gated(std::span<const Recording> radars, const Config& config,
                             const std::function<void(double)>& progress) {
  std::vector<Recording> kept;
  for (const Recording& radar : radars) {
    Recording& own = kept.emplace_back(Recording{radar.nominal, radar.has_elevation, {}});
    for (Detection d : radar.detections) {
      if (!usable(d, radar.has_elevation, config.min_speed_mps)) continue;
      if (!radar.has_elevation) d.elevation_rad = 0.0;
      own.detections.push_back(d);
    }
  }
  if (config.gate_sigma > 0.0) {
    const Eigen::VectorXd fit = robust_yaw_fit(kept, config.gate_floor_mps, progress);
    for (std::size_t r = 0; r < kept.size(); ++r) {
      const std::vector<double> residuals = residuals_of(kept[r], of_radar(fit, r));
      const Centre centre = centre_of(residuals);
      const double limit = std::max(config.gate_sigma * centre.std, config.gate_floor_mps);
      std::vector<Detection> inside;
      for (std::size_t i = 0; i < residuals.size(); ++i) {
        if (std::abs(residuals[i] - centre.median) < limit) inside.push_back(kept[r].detections[i]);
      }
      kept[r].detections = std::move(inside);
    }
  }
  for (Recording& radar : kept) {
    if (radar.detections.size() < config.min_detections) radar.detections.clear();
  }
  return kept;
}

}  // namespace boresight::alignment::batch_calibration
