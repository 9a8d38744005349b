#include "services/tracker/core/seen_centre.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/LU>

namespace boresight::tracking {

namespace {

constexpr double kOutlineScatter_m = 0.2;  // std of the outline: round corners, deep wheel arches
/// What is farther off than that, while something else is not, is of the next vehicle or a ghost.
constexpr double kUsual_m = 0.5;

/// How far past the end of a face of that length.
double past(double along_m, double length_m) {
  return std::max(0.0, std::abs(along_m) - 0.5 * length_m);
}

/// Variance of what lies evenly along a face.
double along(double length_m) {
  return length_m * length_m / 12.0;
}

/// What the detections of one kind of face say, one by one: information, and how far off the box is, each weighed by
/// it.
struct Said {
  Eigen::Matrix2d each;
  Eigen::Vector2d off_m{0.0, 0.0};
  double number = 0.0;
  Said(const Eigen::Matrix2d& noise_m2, double along_m2, double across_m2)
      : each((noise_m2 + Eigen::Vector2d(along_m2, across_m2).asDiagonal().toDenseMatrix()).inverse()) {}
  void add(const Eigen::Vector2d& more_m, double weight) {
    off_m += weight * more_m;
    number += weight;
  }
};

}  // namespace

SeenCentre seen_centre(const Cluster& cluster, const Extent& extent, const Eigen::Vector2d& centre_m,
                       const Eigen::Matrix2d& position_m2, const Eigen::Vector2d& sensor_m) {
  if (extent.is_small) return {cluster.position_m, cluster.covariance_m2};
  const VisibleFaces faces = extent.visible_faces(centre_m, sensor_m);
  const double length_m = extent.length_m, width_m = extent.width_m, rough_m2 = kOutlineScatter_m * kOutlineScatter_m;
  Eigen::Matrix2d to_body;
  to_body.col(0) = extent.to_body({1.0, 0.0});
  to_body.col(1) = extent.to_body({0.0, 1.0});
  const Eigen::Matrix2d noise = to_body * (cluster.weight * cluster.covariance_m2) * to_body.transpose();
  const bool end_seen = faces.end != 0.0, side_seen = faces.side != 0.0;
  // What is rather a ghost, all of it, has a mean and no outline.
  const std::span<const Eigen::Vector2d> detections = cluster.number_on_outline > 0
                                                          ? std::span(cluster.outline).first(cluster.number_on_outline)
                                                          : std::span(&cluster.position_m, 1);
  const double usual_m2 = kUsual_m * kUsual_m + position_m2.trace() + noise.trace();
  struct Look {
    Eigen::Vector2d off_m;
    bool of_side;
    double fits;
  };
  const auto look_at = [&](const Eigen::Vector2d& detection_m) -> Look {
    const Eigen::Vector2d at = extent.to_body(detection_m - centre_m);
    const double beyond_end_m = at.x() - 0.5 * faces.end * length_m;
    const double beyond_side_m = at.y() - 0.5 * faces.side * width_m;
    const bool of_side = side_seen && !(end_seen && std::abs(beyond_end_m) < std::abs(beyond_side_m));
    const double away_m = of_side ? beyond_side_m : beyond_end_m;
    const double past_m = of_side ? past(at.x(), length_m) : past(at.y(), width_m);
    const double fits = 1.0 / (1.0 + (away_m * away_m + past_m * past_m) / usual_m2);
    return {of_side ? Eigen::Vector2d(at.x(), away_m) : Eigen::Vector2d(away_m, at.y()), of_side, fits};
  };
  // Beside the nearest one: where all is far off the box was thought to be elsewhere, and nothing is the less sure.
  double best = 0.0, of_side = 0.0;
  for (const Eigen::Vector2d& detection_m : detections) {
    const Look look = look_at(detection_m);
    best = std::max(best, look.fits);
    of_side += look.of_side ? 1.0 : 0.0;
  }
  // From inside it is anywhere in the box. All that is seen of a flank says no more of where its middle is than one
  // detection would: it is the same parts that reflect, from scan to scan.
  Said by_end(noise, end_seen ? rough_m2 : along(length_m), along(width_m));
  Said by_side(noise, std::max(1.0, of_side) * along(length_m), rough_m2);
  for (const Eigen::Vector2d& detection_m : detections) {
    const Look look = look_at(detection_m);
    (look.of_side ? by_side : by_end).add(look.off_m, look.fits / best);
  }
  const Eigen::Matrix2d covariance = (by_end.number * by_end.each + by_side.number * by_side.each).inverse();
  const Eigen::Vector2d off_m = covariance * (by_end.each * by_end.off_m + by_side.each * by_side.off_m);
  return {centre_m + to_body.transpose() * off_m, to_body.transpose() * covariance * to_body};
}

}  // namespace boresight::tracking
