#include "services/ghost_filter/core/mirror/meeting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/ghost_filter/core/mirror/specular.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kUnseen_m = 5.0;       // as far the mirror of a way by it may go on unseen
constexpr double kLeastWay_m = 0.2;     // to a mirror, and from it
constexpr double kLeastChance = 0.01;   // of there being something where the wave turns
constexpr double kMostError_m = 0.005;  // of a way's length: far less than a range is known by
constexpr int kRounds = 4;
constexpr double kAround_m = 15.0;  // of a mirror: so much farther than to it a way is

}  // namespace

double most_unseen_m(const Mirror& mirror) {
  return is_long(mirror) || mirror.occupancy == nullptr ? kUnseen_m : 0.0;
}

WaysBy::WaysBy(const Mirror& mirror, const Eigen::Vector2d& sensor_m)
    : mirror_(&mirror),
      sensor_m_(sensor_m),
      sensor_(mirror.curve.local(sensor_m)),
      low_m_(mirror.begin_m - most_unseen_m(mirror)),
      high_m_(mirror.end_m + most_unseen_m(mirror)),
      origin2_m2_((mirror.curve.origin_m - sensor_m).squaredNorm()),
      size_m_(std::max(-mirror.begin_m, mirror.end_m)),
      unseen_m_(most_unseen_m(mirror)),
      bend_(std::abs(mirror.curve.curvature_per_m)),
      low_(end_at(low_m_, -1.0)),
      high_(end_at(high_m_, 1.0)) {}

WaysBy::End WaysBy::end_at(double arc_m, double outward) const {
  const Eigen::Vector2d point = mirror_->curve.at(arc_m), out = point - sensor_m_;
  const double first = out.norm();
  return {point, mirror_->curve.tangent_at(arc_m), out / first, first, outward};
}

bool WaysBy::turns_beyond(const End& end, const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                          double length_m) const {
  const Eigen::Vector2d back = from_m - end.point_m;
  const double left = length_m - end.first_m, opening = left + back.dot(direction);
  if (!(end.first_m > kLeastWay_m && opening > 1e-6)) return true;
  const double rest = 0.5 * (left * left - back.squaredNorm()) / opening, second = left - rest;
  if (!(second > kLeastWay_m)) return true;
  const Eigen::Vector2d d = (back + rest * direction) / second;
  const Specular here = specular(end.departure, end.first_m, d, second, end.tangent, mirror_->curve.curvature_per_m);
  return here.error_m > kMostError_m && end.outward * here.step_m > 0.0;
}

std::optional<Approach> WaysBy::approach(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                                         double length_m) const {
  // The way out and the way on to the ray's begin are no shorter than to the nearest point of the mirror and from
  // there.
  const double reach = 0.5 * (length_m + (from_m - sensor_m_).norm()) + (size_m_ + kAround_m);
  if (origin2_m2_ > reach * reach) return std::nullopt;
  return approach_along(from_m, direction, length_m, mirror_->curve.local(from_m));
}

std::optional<Approach> WaysBy::approach(const Eigen::Vector2d& direction, double length_m) const {
  const double reach = 0.5 * length_m + (size_m_ + kAround_m);
  if (origin2_m2_ > reach * reach) return std::nullopt;
  return approach_along(sensor_m_, direction, length_m, sensor_);
}

std::optional<Approach> WaysBy::approach_along(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                                               double length_m, const Eigen::Vector2d& from) const {
  constexpr double kMostBent_rad = 0.2;  // from the origin to where the wave turns
  const Eigen::Vector2d& sensor = sensor_;
  const Eigen::Vector2d along = mirror_->curve.to_local(direction);
  const Eigen::Vector2d back(from.x() - sensor.x(), from.y() + sensor.y());  // from the sensor's image
  Approach way{0.0, 0.0, 0.0, std::numeric_limits<double>::infinity(), 0.0};
  const double denominator = 2.0 * (length_m + back.dot(along));
  if (denominator < 1e-6) return way;
  way.rest_m = (length_m * length_m - back.squaredNorm()) / denominator;
  const Eigen::Vector2d target = from + way.rest_m * along;
  const double bend = bend_;
  const double sag = 1.0 + bend * (sensor.x() * sensor.x() + target.x() * target.x());
  const double share = std::abs(sensor.y()) / std::max(1e-9, std::abs(sensor.y()) + std::abs(target.y()));
  way.arc_m = sensor.x() + (target.x() - sensor.x()) * share;
  // Most mirrors are short, and bent if they are what is seen of a bush: from there a straight one tells little, but
  // beyond which end light would turn.
  if (way.arc_m <= low_m_ ? turns_beyond(low_, from_m, direction, length_m)
                          : way.arc_m >= high_m_ && turns_beyond(high_, from_m, direction, length_m))
    return std::nullopt;
  if (sensor.y() * target.y() <= 0.0) {
    if (std::min(std::abs(sensor.y()), std::abs(target.y())) > sag) return std::nullopt;
    return way;
  }
  const double turns = way.arc_m;
  const double slack = unseen_m_ + 0.5 * bend * size_m_ * length_m + 2.0 * sag;
  if (turns < mirror_->begin_m - slack || turns > mirror_->end_m + slack) return std::nullopt;
  const double second = length_m - way.rest_m;  // from the sensor's image to the target
  const double opening = second + along.dot(target - Eigen::Vector2d(sensor.x(), -sensor.y()));
  const double reached = std::abs(turns) + 5.0;
  if (second <= 0.0 || kMostMetresPerM * opening < second || bend * reached > kMostBent_rad) return way;
  way.metres_per_m = second / opening;
  way.length_std_m = 2.0 * std::abs(sensor.y() + target.y()) / second * std::sqrt(offset_variance_at(*mirror_, turns));
  // At that place a bent mirror is half of this away from the straight one, and a way over it so much longer or
  // shorter; some more, as the wave turns elsewhere.
  const double beside = turns - sensor.x();
  way.error_m = bend * (4.0 * reached * reached + beside * beside) * way.metres_per_m;
  return way;
}

std::optional<Meeting> WaysBy::meet(double near_arc_m, const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction,
                                    double length_m, double least_m) const {
  const Curve& curve = mirror_->curve;
  const Eigen::Vector2d from = curve.local(from_m), along = curve.to_local(direction);
  double arc = std::clamp(near_arc_m, low_m_, high_m_);
  for (int round = 0;; ++round) {
    // Were the wave to turn here, T would be where the length is right; the angles to both sides tell where it turns.
    const Eigen::Vector2d point = curve.local_at(arc), tangent = curve.local_tangent_at(arc);
    const Eigen::Vector2d out = point - sensor_, back = from - point;
    const double first = out.norm(), left = length_m - first;
    const double opening = left + back.dot(along);
    if (!(first > kLeastWay_m && opening > 1e-6)) return std::nullopt;
    const double rest = 0.5 * (left * left - back.squaredNorm()) / opening;
    const double second = left - rest;
    if (!(second > kLeastWay_m)) return std::nullopt;
    const Eigen::Vector2d u = out / first, d = (back + rest * along) / second;
    // T moves as W does, but not at the end, by Fermat's principle: there Newton's method is exact.
    const Specular here = specular(u, first, d, second, tangent, curve.curvature_per_m);
    if (here.error_m > kMostError_m) {
      const double next = std::clamp(arc + here.step_m, low_m_, high_m_);
      if (round == kRounds || next == arc) return std::nullopt;
      arc = next;
      continue;
    }
    // Both on the same side of the mirror.
    if (!here.is_reflection() || rest < least_m) return std::nullopt;
    const double probability = chance_at(*mirror_, arc, 0.5);
    if (probability < kLeastChance) return std::nullopt;
    const Eigen::Vector2d arrival = curve.from_local(d);
    return Meeting{rest,
                   1.0 / std::max(0.02, 1.0 + direction.dot(arrival)),
                   curve.origin_m + curve.from_local(point),
                   curve.from_local(u),
                   arrival,
                   probability,
                   2.0 * std::abs(here.sine_of_departure) * std::sqrt(offset_variance_at(*mirror_, arc))};
  }
}

}  // namespace boresight::ghosts
