#include "services/ghost_filter/core/classify/object.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kWithin = 0.12;  // share of a body's reflections that come from anywhere in the box
constexpr double kEdge = 0.15;    // of a face that only one of the two ends of the path sees, beside one that both see
/// Wheels and what else turns are at the flank, as far as it is seen, of what is as long as a car; else anywhere.
constexpr double kWheelsAtFlank = 0.5, kHalfCar_m = 1.9;

constexpr double kStanding_mps = 0.5;  // what is slower may as well stand

constexpr double kLeastHalf_m = 0.05;  // of a face

/// How much larger than its track's box a vehicle may be, on each side, and how likely that is.
struct Growth {
  double share, length_m, width_m;
};
constexpr std::array<Growth, 3> kGrowths{{{0.8, 0.0, 0.0}, {0.15, 2.5, 0.5}, {0.05, 7.0, 1.5}}};

/// Which end of an axis looks to a place: −1, 0 (beside the box, within its extent), +1.
int side(double coordinate, double half) {
  return coordinate > half ? 1 : coordinate < -half ? -1 : 0;
}

/// A normal distribution across a face, along which it is cut off at the ends.
struct AcrossFace {
  double variance, norm, slope, per_std_along;
  AcrossFace(double across, double along, double both)
      : variance(across),
        norm(1.0 / std::sqrt(2.0 * M_PI * across)),
        slope(both / across),
        per_std_along(1.0 / std::sqrt(std::max(1e-6, along - both * both / across))) {}
  /// Density at a place (along, across) of what lies evenly on the face from −half to half.
  [[nodiscard]] double density(double along, double away, double half) const {
    const double chi2 = away * away / variance;
    if (chi2 > kFarthest2) return 0.0;
    const double middle = along - slope * away;
    const double share = below((middle + half) * per_std_along) - below((middle - half) * per_std_along);
    return norm * exponential(-0.5 * chi2) * std::max(0.0, share) / (2.0 * std::max(kLeastHalf_m, half));
  }
};

/// Everything in the box's axes: the place from the box's centre with its covariance, and the path's ends.
struct InBox {
  Eigen::Vector2d place, from, lit;
  double xx, xy, yy;
};

class Faces {
 public:
  explicit Faces(const InBox& in)
      : in_(in),
        per_determinant_(1.0 / std::max(1e-12, in.xx * in.yy - in.xy * in.xy)),
        blur_(2.0 * M_PI / std::sqrt(per_determinant_)),
        across_{{{in.xx, in.yy, in.xy}, {in.yy, in.xx, in.xy}}} {}

  [[nodiscard]] Reflections of_box(const Eigen::Vector2d& half) const {
    const double x = beyond(in_.place.x(), half.x()), y = beyond(in_.place.y(), half.y());
    // Too far along one axis is too far.
    if (x * x > kFarthest2 * in_.xx || y * y > kFarthest2 * in_.yy) return {0.0, 0.0};
    const double chi2 = (in_.yy * x * x - 2.0 * in_.xy * x * y + in_.xx * y * y) * per_determinant_;
    if (chi2 > kFarthest2) return {0.0, 0.0};  // no face is nearer than the box
    const double anywhere = exponential(-0.5 * chi2) / (blur_ + 4.0 * half.x() * half.y());
    // Reflections are as many for each metre of any face, so that a truck's flank shows far more than its rear.
    double sum = 0.0, weights = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
      const int seen = side(in_.from(axis), half(axis)), shone = side(in_.lit(axis), half(axis));
      for (const int end : {-1, 1}) {
        const double lit = seen == end && shone == end ? 1.0 : seen == end || shone == end ? kEdge : 0.0;
        if (lit <= 0.0) continue;
        const double weight = lit * std::max(kLeastHalf_m, half(1 - axis));
        weights += weight;
        sum += weight * across_[static_cast<std::size_t>(axis)].density(
                            in_.place(1 - axis), in_.place(axis) - end * half(axis), half(1 - axis));
      }
    }
    return {weights > 0.0 ? kWithin * anywhere + (1.0 - kWithin) * sum / weights : anywhere, wheel(half, anywhere)};
  }

 private:
  [[nodiscard]] double wheel(const Eigen::Vector2d& half, double anywhere) const {
    const int flank = side(in_.from.y(), half.y());
    if (flank == 0 || half.x() < kHalfCar_m) return anywhere;
    const double at_flank = across_[1].density(in_.place.x(), in_.place.y() - flank * half.y(), half.x());
    return kWheelsAtFlank * at_flank + (1.0 - kWheelsAtFlank) * anywhere;
  }
  [[nodiscard]] static double beyond(double coordinate, double half) {
    return coordinate - std::clamp(coordinate, -half, half);
  }
  const InBox& in_;
  double per_determinant_, blur_;
  std::array<AcrossFace, 2> across_;  // the faces at the ends of x, and of y
};

}  // namespace

Eigen::Vector2d most_extent(const Object& object) {
  const Eigen::Vector2d axis = object.axis.cwiseAbs();
  const double length = object.half_length_m + kGrowths.back().length_m;
  const double width = object.half_width_m + kGrowths.back().width_m;
  return {axis.x() * length + axis.y() * width, axis.y() * length + axis.x() * width};
}

bool is_beyond(const Object& object, const Eigen::Vector2d& place_m, const Eigen::Vector2d& direction,
               double variance_m2) {
  const double along = std::abs(direction.dot(object.axis)), across = std::abs(left_of(direction).dot(object.axis));
  const double half = along * (object.half_length_m + kGrowths.back().length_m) +
                      across * (object.half_width_m + kGrowths.back().width_m);
  const double beyond = std::abs(direction.dot(object.position_m - place_m)) - half;
  if (beyond <= 0.0) return false;
  // In no direction a place is nearer, in its standard deviations, than in the one in which it is farthest.
  return square(beyond) > kFarthest2 * (variance_m2 + direction.dot(object.position_covariance * direction));
}

Reflections reflections_at(const Object& object, const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance,
                           const Eigen::Vector2d& seen_from_m, const Eigen::Vector2d& lit_from_m) {
  const Eigen::Vector2d q = place_m - object.position_m;
  const double most_x = object.half_length_m + kGrowths.back().length_m;
  const double most_y = object.half_width_m + kGrowths.back().width_m;
  const double c = object.axis.x(), s = object.axis.y();
  const double xx = covariance(0, 0) + object.position_covariance(0, 0);
  const double yy = covariance(1, 1) + object.position_covariance(1, 1);
  const double xy = covariance(0, 1) + object.position_covariance(0, 1);
  const auto turned = [c, s](const Eigen::Vector2d& v) {
    return Eigen::Vector2d(c * v.x() + s * v.y(), c * v.y() - s * v.x());
  };
  InBox in;
  in.place = turned(q);
  in.xx = c * c * xx + 2.0 * c * s * xy + s * s * yy;
  in.yy = s * s * xx - 2.0 * c * s * xy + c * c * yy;
  const auto is_far = [](double beyond, double variance) {
    return beyond > 0.0 && beyond * beyond > kFarthest2 * variance;
  };
  if (is_far(std::abs(in.place.x()) - most_x, in.xx) || is_far(std::abs(in.place.y()) - most_y, in.yy)) {
    return {0.0, 0.0};
  }
  in.xy = c * s * (yy - xx) + (c * c - s * s) * xy;
  in.from = turned(seen_from_m - object.position_m);
  in.lit = turned(lit_from_m - object.position_m);
  const Faces faces(in);
  Reflections sum{0.0, 0.0};
  for (const Growth& growth : kGrowths) {
    const Reflections there =
        faces.of_box({object.half_length_m + growth.length_m, object.half_width_m + growth.width_m});
    sum.body += growth.share * there.body;
    sum.wheel += growth.share * there.wheel;
  }
  return sum;
}

bool moves_surely(const Object& object) {
  const Eigen::Matrix2d& p = object.velocity_covariance;
  const Eigen::Vector2d& v = object.velocity_mps;
  if (v.squaredNorm() < square(kStanding_mps)) return false;
  // vᵀP⁻¹v against three standard deviations.
  const double determinant = p(0, 0) * p(1, 1) - p(0, 1) * p(1, 0);
  return p(1, 1) * square(v.x()) - 2.0 * p(0, 1) * v.x() * v.y() + p(0, 0) * square(v.y()) > 9.0 * determinant;
}

double moving_of(const Object& object) {
  if (moves_surely(object)) return 1.0;
  const double speed_mps = object.velocity_mps.norm();
  if (speed_mps <= kStanding_mps) return 0.0;
  const Eigen::Vector2d course = object.velocity_mps / speed_mps;
  return below((speed_mps - kStanding_mps) /
               std::sqrt(std::max(1e-9, course.dot(object.velocity_covariance * course))));
}

double body_rate_at(const Object& object, double rate_mps, const Eigen::Vector2d& q, double noise_variance) {
  return gaussian(rate_mps - q.dot(object.velocity_mps), noise_variance + q.dot(object.velocity_covariance * q));
}

RateDensity rates_at(const Object& object, double rate_mps, const Eigen::Vector2d& q, double noise_variance) {
  const double mean = q.dot(object.velocity_mps);
  const double variance = noise_variance + q.dot(object.velocity_covariance * q);
  const double std = std::sqrt(variance), spread = std::max(0.5, std::abs(mean));
  const double share = below((rate_mps - mean + spread) / std) - below((rate_mps - mean - spread) / std);
  return {gaussian(rate_mps - mean, variance), std::max(0.0, share) / (2.0 * spread)};
}

}  // namespace boresight::ghosts
