#include "services/tracker/core/surroundings/edge_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace boresight::tracking {

namespace {

/// The x of the line's place that lies at x = 0 of axes turned by `yaw_rad`: cos·x + sin·y(x) = 0, by Newton's method.
double abeam(const Eigen::Vector3d& c, double yaw_rad) {
  constexpr int kSteps = 3;
  const double cosine = std::cos(yaw_rad), sine = std::sin(yaw_rad);
  double x = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    x -= (cosine * x + sine * EdgeLine::basis(x).dot(c)) / (cosine + sine * (c(1) + c(2) * x));
  }
  return x;
}

}  // namespace

void EdgeLine::predict(const geometry::EgoStep& step, double yaw_rad, const RoadEdgeParameters& parameters) {
  const double dx = step.translation_m.x(), dy = step.translation_m.y();
  Eigen::Matrix3d shift;
  shift << 1.0, dx, 0.5 * dx * dx, 0.0, 1.0, dx, 0.0, 0.0, 1.0;
  c = shift * c - Eigen::Vector3d(dy, 0.0, 0.0);
  // Turned: the parabola through the place that comes to lie abeam, with the direction and the curvature there.
  const double foot_m = abeam(c, yaw_rad);
  const double y_m = basis(foot_m).dot(c), direction_rad = std::atan(c(1) + c(2) * foot_m);
  const double turned_rad = direction_rad - yaw_rad;
  const double stretch = std::cos(direction_rad) / std::cos(turned_rad);
  c = {-std::sin(yaw_rad) * foot_m + std::cos(yaw_rad) * y_m, std::tan(turned_rad), c(2) * stretch * stretch * stretch};
  covariance = shift * covariance * shift.transpose();
  const double driven_m = std::hypot(dx, dy);
  covariance(0, 0) += parameters.offset_density_m2pm * driven_m;
  covariance(1, 1) += parameters.slope_density_pm * driven_m;
  covariance(2, 2) += parameters.curvature_density_pm3 * driven_m;
}

double EdgeLine::noise_m2(const StationaryPoint& p, double scatter_m2, const RoadEdgeParameters& parameters) const {
  const double x = p.position_m.x();
  const Eigen::Vector2d across(-slope(x), 1.0);
  const double departs_m = parameters.curvature_rate_std_pm2 * x * x * x / 6.0;
  return across.dot(p.covariance_m2 * across) + scatter_m2 * across.squaredNorm() + departs_m * departs_m;
}

EdgeEvidence EdgeLine::update(std::span<const StationaryPoint> points, double side, const EdgeDensities& densities,
                              double scatter_m2, const RoadEdgeParameters& parameters) {
  EdgeEvidence found;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (const StationaryPoint& p : points) {
    const double x = p.position_m.x();
    if (x > parameters.ahead_m) continue;
    const double residual = p.position_m.y() - at(x);
    if (std::abs(residual) > 2.0 * parameters.gate_sigma * parameters.band_half_width_m) continue;
    const double noise = noise_m2(p, scatter_m2, parameters);
    const double spread = noise + variance_m2(x);
    if (residual * residual > parameters.gate_sigma * parameters.gate_sigma * spread) continue;
    const double on =
        densities.on * std::exp(-0.5 * residual * residual / spread) / std::sqrt(2.0 * std::numbers::pi * spread);
    const double beside = residual * side < 0.0 ? densities.inner_per_m : densities.outer_per_m;
    const double weight = on / (on + beside);
    if (!(weight > parameters.least_weight)) continue;
    const Eigen::Vector3d h = basis(x);
    const double precision = weight / (noise * parameters.repeat_factor);
    information += precision * h * h.transpose();
    vector += precision * residual * h;
    found.detections += weight;
    found.is_seen = found.is_seen || weight > 0.5;
    const double radar_m2 = noise - scatter_m2;
    found.squares_m2 += weight * (residual * residual - radar_m2 - variance_m2(x)) / (1.0 + radar_m2 / scatter_m2);
    found.weights += weight / (1.0 + radar_m2 / scatter_m2);
  }
  if (found.weights <= 0.0) return found;
  // P⁺ = (P⁻¹ + I)⁻¹ = (1 + P I)⁻¹ P, without an inverse of P.
  const Eigen::Matrix3d gain = (Eigen::Matrix3d::Identity() + covariance * information).inverse();
  covariance = gain * covariance;
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  c += covariance * vector;
  return found;
}

}  // namespace boresight::tracking
