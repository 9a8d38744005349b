// A vehicle as the filter knows it from its track, and how much it reflects where.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/sectors.hpp"
#include "services/ghost_filter/core/classify/strength.hpp"

namespace boresight::ghosts {

/// A tracked vehicle, or the own one, predicted to the scan; vehicle frame and axes.
struct Object {
  Eigen::Vector2d position_m{0.0, 0.0};  ///< centre
  Eigen::Vector2d axis{1.0, 0.0};        ///< of its length, unit
  double half_length_m = 0.0, half_width_m = 0.0;
  Eigen::Vector2d velocity_mps{0.0, 0.0};  ///< over ground
  Eigen::Matrix2d position_covariance = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d velocity_covariance = Eigen::Matrix2d::Zero();
  double weight = 0.0;   ///< probability that it exists and is no image itself
  double image = 0.0;    ///< that it exists and is an image
  double mirrors = 0.0;  ///< log-odds that its faces do, more than those of others as long: images were seen in them
  double moving = 1.0;   ///< probability that it does not just stand
  double age_s = 1e9;    ///< since it was first tracked
  bool own = false;      ///< the own vehicle: seen only in mirrors
  double reach_m = 1e9;  ///< from its centre: farther away nothing is of it, as well as it is known where it is
  SectorSet sectors = kAllSectors;                                 ///< in which the sensor sees all of that
  double rcs_dbsm = kUsualRcs_dbsm, rcs_std_db = kUsualRcsStd_db;  ///< of its parts, on average
};

/// Whether a place lies within the object's box, widened by `around_m` on each side.
[[nodiscard]] inline bool is_on(const Object& object, const Eigen::Vector2d& place_m, double around_m) {
  const Eigen::Vector2d q = place_m - object.position_m;
  return std::abs(q.dot(object.axis)) <= object.half_length_m + around_m &&
         std::abs(object.axis.x() * q.y() - object.axis.y() * q.x()) <= object.half_width_m + around_m;
}

/// Half the extent along x and y of all that may belong to it, were it as large as can be.
[[nodiscard]] Eigen::Vector2d most_extent(const Object& object);

/// Whether a place that is known along a direction (unit) with that variance is too far from the object along it for
/// anything there to be of it, were it as large as can be.
[[nodiscard]] bool is_beyond(const Object& object, const Eigen::Vector2d& place_m, const Eigen::Vector2d& direction,
                             double variance_m2);

/// Whether the object's speed is beyond doubt.
[[nodiscard]] bool moves_surely(const Object& object);
/// Probability that the object moves, by its velocity and what is not known of that.
[[nodiscard]] double moving_of(const Object& object);

/// Densities for each m² of an object's reflections at a place, the number of each kind being 1.
struct Reflections {
  double body;   ///< from the faces that look to where the wave comes from and goes to, a little from the others' edges
  double wheel;  ///< from the flank, or from anywhere in the box
};
/// A vehicle may be larger than its track's box: a young track's, or one's that shows one face only.
/// At a place that is known with `covariance`, seen from and lit from (the last and the first corner of the path).
[[nodiscard]] Reflections reflections_at(const Object& object, const Eigen::Vector2d& place_m,
                                         const Eigen::Matrix2d& covariance, const Eigen::Vector2d& seen_from_m,
                                         const Eigen::Vector2d& lit_from_m);

/// Density of a range rate over ground, given as q·v + known, for a part that goes with the body and for one that
/// turns (a wheel's rim, a leg: its speed is anything between nothing and twice the body's).
struct RateDensity {
  double body, wheel;
};
[[nodiscard]] RateDensity rates_at(const Object& object, double rate_mps, const Eigen::Vector2d& q,
                                   double noise_variance);
[[nodiscard]] double body_rate_at(const Object& object, double rate_mps, const Eigen::Vector2d& q,
                                  double noise_variance);

}  // namespace boresight::ghosts
