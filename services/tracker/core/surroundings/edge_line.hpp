// A line y(x) = c0 + c1 x + c2 x²/2 beside the vehicle with its covariance. Equations (W3)…(W6).
#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/LU>

#include "services/common/geometry/ego_step.hpp"
#include "services/tracker/core/surroundings/parameters.hpp"
#include "services/tracker/core/surroundings/stationary_memory.hpp"

namespace boresight::tracking {

/// Detections per metre across the line, over its length, by which one is distinguished from those beside it.
struct EdgeDensities {
  double on = 1.0;  ///< number on the line, without those beside it
  double inner_per_m = 1.0, outer_per_m = 1.0;
};

/// What one scan shows of a line.
struct EdgeEvidence {
  double detections = 0.0;  ///< on the line, by their weights
  double squares_m2 = 0.0;  ///< weighted squares of residuals without the radars' noise
  double weights = 0.0;     //
  bool is_seen = false;     ///< at least one is likelier on the line than beside it
};

struct EdgeLine {
  Eigen::Vector3d c{0.0, 0.0, 0.0};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();

  [[nodiscard]] static Eigen::Vector3d basis(double x_m) { return {1.0, x_m, 0.5 * x_m * x_m}; }
  [[nodiscard]] double at(double x_m) const { return basis(x_m).dot(c); }
  [[nodiscard]] double slope(double x_m) const { return c(1) + c(2) * x_m; }
  [[nodiscard]] double variance_m2(double x_m) const { return basis(x_m).dot(covariance * basis(x_m)); }

  /// Into the vehicle frame after an ego step that turned it by `yaw_rad`, (W4); adds the process noise of the
  /// distance.
  void predict(const geometry::EgoStep& step, double yaw_rad, const RoadEdgeParameters& parameters);
  /// Variance of a detection about the line, across it in y: radar noise, scatter, and departure from a parabola.
  [[nodiscard]] double noise_m2(const StationaryPoint& p, double scatter_m2,
                                const RoadEdgeParameters& parameters) const;
  /// Takes the detections of a scan, each weighted by its probability of lying on the line, (W5), (W6). `side`: +1
  /// left.
  EdgeEvidence update(std::span<const StationaryPoint> points, double side, const EdgeDensities& densities,
                      double scatter_m2, const RoadEdgeParameters& parameters);
};

}  // namespace boresight::tracking
