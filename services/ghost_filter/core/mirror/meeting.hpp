// Where something would have to be that is reached by way of a mirror.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "services/ghost_filter/core/mirror/mirror.hpp"

namespace boresight::ghosts {

/// How far beyond its ends the mirror of a way by it may go on unseen.
[[nodiscard]] double most_unseen_m(const Mirror& mirror);

/// The most of `metres_per_m` that is told without following a way: beyond it what is found hangs on little.
inline constexpr double kMostMetresPerM = 5.0;

/// Where meet() would find it, were the mirror straight: what is known of most ways without following them.
struct Approach {
  double rest_m, metres_per_m;
  double length_std_m;  ///< of the way by the mirror
  double error_m;       ///< as far off `rest_m` may be; infinite where that is not known
  double arc_m;         ///< where on the mirror the wave would turn
};

/// A place T on a ray, and the way from the sensor by a mirror to it.
struct Meeting {
  double rest_m;              ///< from the ray's begin to T
  double metres_per_m;        ///< by which T lies farther if the whole way is longer by one metre
  Eigen::Vector2d point_m;    ///< W, where the wave turns
  Eigen::Vector2d departure;  ///< u: from the sensor to W, unit
  Eigen::Vector2d arrival;    ///< d: from W to T, unit
  double probability;         ///< that there is something at W
  double length_std_m;        ///< of the way by the mirror
};

/// What ways by a mirror from one sensor have in common: many are asked for in a scan, most of them to be left out.
/// The mirror is referred to.
class WaysBy {
 public:
  WaysBy(const Mirror& mirror, const Eigen::Vector2d& sensor_m);
  [[nodiscard]] const Mirror& mirror() const { return *mirror_; }
  /// Where meet() would find it, were the mirror straight. Nothing if the wave would turn beyond the mirror's ends, or
  /// on its other side, however the mirror may be bent.
  [[nodiscard]] std::optional<Approach> approach(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                                                 double length_m) const;
  /// The same of rays from the sensor itself, which are most.
  [[nodiscard]] std::optional<Approach> approach(const Eigen::Vector2d& direction, double length_m) const;
  /// The place T on the ray from `from_m` (unit `direction`) for which |T − from| and the way from the sensor by the
  /// mirror to T have the sum `length_m`, found from `near_arc_m` on. Nothing if there is none, or less than `least_m`
  /// along.
  [[nodiscard]] std::optional<Meeting> meet(double near_arc_m, const Eigen::Vector2d& from_m,
                                            const Eigen::Vector2d& direction, double length_m, double least_m) const;

 private:
  /// Of the arc lengths between which waves turn, the first or the last one.
  struct End {
    Eigen::Vector2d point_m, tangent, departure;  // the latter from the sensor, unit
    double first_m;                               // from the sensor
    double outward;                               // 1 where the arc length grows beyond it, else −1
  };
  /// `from` is the ray's begin in the curve's axes.
  [[nodiscard]] std::optional<Approach> approach_along(const Eigen::Vector2d& begin_m, const Eigen::Vector2d& direction,
                                                       double length_m, const Eigen::Vector2d& from) const;
  [[nodiscard]] End end_at(double arc_m, double outward) const;
  /// Whether meet(), begun at an end, would have to go on beyond it.
  [[nodiscard]] bool turns_beyond(const End& end, const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                                  double length_m) const;
  const Mirror* mirror_;
  Eigen::Vector2d sensor_m_, sensor_;  // the latter in the curve's axes
  double low_m_, high_m_;              // between which arc lengths waves turn
  double origin2_m2_;                  // squared distance of the curve's origin from the sensor
  double size_m_;                      // as far from that the mirror reaches, and some more
  double unseen_m_, bend_;
  End low_, high_;
};

}  // namespace boresight::ghosts
