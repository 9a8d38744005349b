#include "services/ghost_filter/core/classify/judge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace boresight::ghosts {

namespace {

constexpr std::size_t kWaysPerTarget = 12;
constexpr double kSpeedAlong_mps = 20.0, kSpeedAcross_mps = 1.5, kSpeedAnyway_mps = 10.0;
constexpr double kAlongShare = 0.75;
constexpr double kHiddenRate_mps = 5.0;  // by which a type-1 ghost's range rate differs from its object's

/// How much larger than its track's box a vehicle may be, on each side, and how likely that is.
struct Growth {
  double share, length_m, width_m;
};
constexpr std::array<Growth, 3> kGrowths{{{0.85, 0.0, 0.0}, {0.12, 2.5, 0.5}, {0.03, 7.0, 0.6}}};

double gaussian(double residual, double variance) {
  const double square = residual * residual / variance;
  return square > 50.0 ? 0.0 : std::exp(-0.5 * square) / std::sqrt(2.0 * M_PI * variance);
}

/// Density of what an object reflects at a place: even over its box, blurred.
double at_box(const Object& object, const Eigen::Vector2d& place_m, const Eigen::Matrix2d& covariance) {
  const Eigen::Vector2d q = place_m - object.position_m;
  const double reach = object.half_length_m + object.half_width_m +
                       7.1 * std::sqrt(covariance.trace() + object.position_covariance.trace());
  if (q.squaredNorm() > reach * reach) return 0.0;
  Eigen::Matrix2d axes;  // rows: the box's axes
  axes << object.axis.x(), object.axis.y(), -object.axis.y(), object.axis.x();
  const Eigen::Vector2d local = axes * q;
  const Eigen::Vector2d half(object.half_length_m, object.half_width_m);
  const Eigen::Vector2d residual = local - local.cwiseMax(-half).cwiseMin(half);
  const Eigen::Matrix2d s = axes * (covariance + object.position_covariance) * axes.transpose();
  const double determinant = s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0);
  if (!(determinant > 0.0)) return 0.0;
  const double square = (s(1, 1) * residual.x() * residual.x() - 2.0 * s(0, 1) * residual.x() * residual.y() +
                         s(0, 0) * residual.y() * residual.y()) /
                        determinant;
  if (square > 50.0) return 0.0;
  return std::exp(-0.5 * square) / (2.0 * M_PI * std::sqrt(determinant) + 4.0 * half.x() * half.y());
}

double at_point(const Eigen::Vector2d& residual, const Eigen::Matrix2d& covariance) {
  const double determinant = covariance(0, 0) * covariance(1, 1) - covariance(0, 1) * covariance(1, 0);
  if (!(determinant > 0.0)) return 0.0;
  const double square =
      (covariance(1, 1) * residual.x() * residual.x() - 2.0 * covariance(0, 1) * residual.x() * residual.y() +
       covariance(0, 0) * residual.y() * residual.y()) /
      determinant;
  return square > 50.0 ? 0.0 : std::exp(-0.5 * square) / (2.0 * M_PI * std::sqrt(determinant));
}

/// Density of `value` as q·v, of a velocity v of which one component is measured, e·v = rate: most go along the mirror
/// (rails and walls follow the road), the others anywhere.
double rate_density(double value, const Eigen::Vector2d& q, const Eigen::Vector2d& e, double rate, double rate_variance,
                    const Eigen::Vector2d& along, double variance) {
  const Eigen::Vector2d across(-along.y(), along.x());
  const auto given = [&](double var_along, double var_across) {
    const double qa = q.dot(along), qc = q.dot(across), ea = e.dot(along), ec = e.dot(across);
    const double qe = qa * ea * var_along + qc * ec * var_across;
    const double ee = ea * ea * var_along + ec * ec * var_across + rate_variance;
    const double qq = qa * qa * var_along + qc * qc * var_across;
    return gaussian(value - qe / ee * rate, std::max(0.0, qq - qe * qe / ee) + variance);
  };
  return kAlongShare * given(kSpeedAlong_mps * kSpeedAlong_mps, kSpeedAcross_mps * kSpeedAcross_mps) +
         (1.0 - kAlongShare) * given(kSpeedAnyway_mps * kSpeedAnyway_mps, kSpeedAnyway_mps * kSpeedAnyway_mps);
}

Eigen::Matrix2d outer(const Eigen::Vector2d& v, double variance) {
  return variance * (v * v.transpose());
}

Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

double square(double x) {
  return x * x;
}

}  // namespace

Judge::Judge(const ClassConfig& config) : config_(config), slots_(kMaxObjects + kMaxDetections) {
  ways_.reserve(slots_.size() * kWaysPerTarget);
}

void Judge::begin(const Surroundings& surroundings) {
  s_ = surroundings;
  std::fill(slots_.begin(), slots_.end(), Ways{});
  ways_.clear();
}

std::span<const Judge::Way> Judge::ways_to(std::size_t slot, const Eigen::Vector2d& target_m) {
  Ways& ways = slots_[slot];
  if (!ways.known) {
    ways = {static_cast<std::uint32_t>(ways_.size()), 0, true};
    for (std::uint32_t i = 0; i < s_.mirrors.size() && ways.count < kWaysPerTarget; ++i) {
      if (s_.mirrors[i].body == slot) continue;
      const std::optional<Detour> detour = detour_to(s_.mirrors[i], s_.sensor_m, target_m);
      if (!detour) continue;
      ways_.push_back({*detour, i});
      ++ways.count;
    }
  }
  return {ways_.data() + ways.begin, ways.count};
}

double Judge::of_objects(const Measured& m, std::uint32_t but_object) const {
  const Eigen::Matrix2d covariance = outer(m.direction, square(m.range_std_m) + 0.09) +
                                     outer(left_of(m.direction), square(m.range_m * m.azimuth_std_rad) + 0.09);
  double density = 0.0;
  for (std::uint32_t i = 0; i < s_.objects.size(); ++i) {
    const Object& o = s_.objects[i];
    if (i == but_object || o.own) continue;
    if ((o.position_m - m.position_m).squaredNorm() > square(o.half_length_m + 20.0)) continue;
    // The box of a young track, or of one that shows its rear only, is shorter than the vehicle.
    double place = 0.0;
    for (const Growth& growth : kGrowths) {
      Object grown = o;
      grown.half_length_m += growth.length_m;
      grown.half_width_m += growth.width_m;
      place += growth.share * at_box(grown, m.position_m, covariance);
    }
    if (place <= 0.0) continue;
    const double variance = m.direction.dot(o.velocity_covariance * m.direction) + square(m.rate_std_mps) +
                            square(config_.range_rate_slack_mps);
    density +=
        o.weight * config_.real_per_object * place * gaussian(m.rate_mps - m.direction.dot(o.velocity_mps), variance);
  }
  return density;
}

bool Judge::is_known_still(const Measured& m) const {
  const std::uint32_t at = s_.stationary->index_at(s_.odometry->point_to_frame(m.position_m));
  return at != StationaryGrid::kUnclaimed && s_.stationary->cells()[at].count >= 2;
}

double Judge::of_stationary(const Measured& m) const {
  const bool known = is_known_still(m);
  // The tail of the errors is fatter than Gaussian.
  const double fit =
      0.95 * gaussian(m.rate_mps, square(m.still_std_mps)) + 0.05 * gaussian(m.rate_mps, square(2.5 * m.still_std_mps));
  return (known ? 0.3 : 0.01) * fit;
}

bool Judge::has_company(const Measured& m, std::uint32_t index) const {
  bool found = false;
  const Eigen::Vector2d place = s_.odometry->point_to_frame(m.position_m);
  const std::int64_t now_ns = s_.odometry->now_ns();
  const std::size_t own = s_.movers->earlier();
  s_.movers->near(place, [&](const Mover& mover, std::uint32_t number) {
    if (found || (number >= own && mover.index == index)) return;
    const double elapsed_s = static_cast<double>(now_ns - mover.time_ns) * 1e-9;
    const Eigen::Vector2d moved = mover.position_m + elapsed_s * mover.rate_mps * mover.direction;
    if ((moved - place).squaredNorm() > 9.0) return;
    found = std::abs(mover.rate_mps - m.rate_mps) < 1.5;
  });
  return found;
}

double Judge::behind_mirror(const Measured& m) const {
  double most = 0.0;
  for (const Mirror& mirror : s_.mirrors) {
    const auto turn = turn_at(mirror, s_.sensor_m, m.direction, m.range_m - config_.margin_m, m.azimuth_std_rad);
    if (turn) most = std::max(most, turn->probability);
  }
  return most;
}

double Judge::type2(const Measured& m, const Mirror& mirror, const Turn& turn, std::uint32_t but_object) const {
  const Eigen::Vector2d& d = turn.direction;
  const Eigen::Vector2d along = left_of(turn.normal);
  const double carried = (m.direction - d).dot(mirror.velocity_mps);
  const double direction_std = std::hypot(m.azimuth_std_rad, 2.0 * turn.angle_std_rad);
  const std::int64_t now_ns = s_.odometry->now_ns();
  double density = config_.lone_ghost_density;
  for (const int bounces : {3, 2}) {
    const auto rest_at = [&](double range) {
      return bounces == 3 ? rest_of_three_bounces(turn, range) : rest_of_two_bounces(turn, s_.sensor_m, range);
    };
    const double rest = rest_at(m.range_m);
    if (rest < 0.5) continue;
    const Eigen::Vector2d place = turn.point_m + rest * d;
    const double along_std = rest_at(m.range_m + m.range_std_m) - rest;
    const double across_std =
        m.azimuth_std_rad * (turn.distance_m + rest + 2.0 * rest * turn.distance_m * turn.focus_per_m);
    const Eigen::Matrix2d covariance = outer(d, square(along_std)) +
                                       outer(left_of(d), square(across_std) + square(2.0 * rest * turn.angle_std_rad)) +
                                       outer(turn.normal, square(2.0 * turn.offset_std_m));
    // The range rate over ground is q·v + known.
    const Eigen::Vector2d e = (place - s_.sensor_m).normalized();
    const Eigen::Vector2d q = bounces == 3 ? d : Eigen::Vector2d(0.5 * (d + e));
    const double known = bounces == 3 ? carried : 0.5 * (carried + (m.direction - e).dot(s_.sensor_velocity_mps));
    const double noise = square(m.rate_std_mps) + square(config_.range_rate_slack_mps);

    const Eigen::Matrix2d spread = covariance + square(0.5) * Eigen::Matrix2d::Identity();
    for (std::uint32_t i = 0; i < s_.objects.size(); ++i) {
      const Object& o = s_.objects[i];
      if (i == but_object || i == mirror.body || (o.own && bounces == 2)) continue;
      const double there = at_box(o, place, spread);
      if (there <= 0.0) continue;
      const double variance =
          q.dot(o.velocity_covariance * q) + noise + square(direction_std) * o.velocity_mps.squaredNorm();
      density += 0.5 * config_.type2_per_object * o.weight * there *
                 gaussian(m.rate_mps - known - q.dot(o.velocity_mps), variance);
    }
    // Objects that are not tracked (yet) have been detected at least. Several detections are of one object.
    double most = 0.0;
    const Eigen::Vector2d in_frame = s_.odometry->point_to_frame(place);
    s_.movers->near(in_frame, [&](const Mover& mover, std::uint32_t) {
      const double elapsed_s = static_cast<double>(now_ns - mover.time_ns) * 1e-9;
      const Eigen::Vector2d moved = mover.position_m + elapsed_s * mover.rate_mps * mover.direction;
      const Eigen::Vector2d residual = s_.odometry->vector_to_vehicle(moved - in_frame);
      if (mover.weight < 0.1 && most > 0.0) return;
      const double loose = square(config_.extent_std_m) + mover.variance_m2 + square(8.0 * elapsed_s);
      const double there = at_point(residual, covariance + loose * Eigen::Matrix2d::Identity());
      if (there <= 0.0) return;
      const double fits =
          rate_density(m.rate_mps - known, q, s_.odometry->vector_to_vehicle(mover.direction), mover.rate_mps,
                       square(config_.range_rate_slack_mps), along, noise + square(15.0 * direction_std));
      most = std::max(most, mover.weight * there * fits);
    });
    density += 0.5 * config_.type2_per_object * most;
    if (bounces == 2) {
      // What stands still has no range rate of its own: by two bounces it seems to have one, which is known.
      const double turn_std = std::min(0.5, across_std / std::max(1.0, (place - s_.sensor_m).norm()));
      const double variance = noise + square(0.5 * turn_std) * s_.sensor_velocity_mps.squaredNorm();
      const bool stands = s_.stationary->index_at(in_frame) != StationaryGrid::kUnclaimed;
      density += (stands ? 1.0 : 0.02) * config_.stationary_image_density * gaussian(m.rate_mps - known, variance);
    }
  }
  return turn.probability * density;
}

double Judge::type1(const Measured& m, std::uint32_t index, std::uint32_t but_object, bool& hidden) {
  double density = 0.0;
  hidden = false;
  // Range, range rate and direction by each mirror; `e_rate` is what the target does in the line of sight.
  const auto by_mirrors = [&](std::size_t slot, const Eigen::Vector2d& target, double extent_std, double width,
                              const auto& rate_fits) {
    const double direct = (target - s_.sensor_m).norm();
    double sum = 0.0;
    for (const Way& way : ways_to(slot, target)) {
      const double expected = 0.5 * (direct + way.detour.length_m);
      const double variance = square(m.range_std_m) + square(extent_std) + square(0.5 * way.detour.length_std_m);
      const double there = gaussian(m.range_m - expected, variance);
      if (there <= 1e-9) continue;
      const Mirror& mirror = s_.mirrors[way.mirror];
      const Eigen::Vector2d& u = way.detour.departure;
      const Eigen::Vector2d& d = way.detour.arrival;
      const double known = 0.5 * ((m.direction - u).dot(s_.sensor_velocity_mps) + (u - d).dot(mirror.velocity_mps));
      const Eigen::Vector2d q = 0.5 * (m.direction + d);
      sum += way.detour.probability * there * rate_fits(q, known, mirror, d);
    }
    return config_.type1_per_object * sum / width;
  };
  const double noise = square(m.rate_std_mps) + square(config_.range_rate_slack_mps);
  for (std::uint32_t i = 0; i < s_.objects.size(); ++i) {
    const Object& o = s_.objects[i];
    if (i == but_object || o.own || o.weight < 0.05) continue;
    const Eigen::Vector2d sight = o.position_m - s_.sensor_m;
    const double depth = sight.dot(m.direction), beside = std::abs(sight.dot(left_of(m.direction)));
    if (depth < 1.0 || depth > m.range_m) continue;
    const double along = std::abs(o.axis.dot(m.direction)), across = std::abs(o.axis.dot(left_of(m.direction)));
    const double half_depth = o.half_length_m * along + o.half_width_m * across;
    const double half_width = o.half_length_m * across + o.half_width_m * along;
    const double blur = depth * m.azimuth_std_rad;
    if (beside > half_width + 2.0 * blur + 0.3 || m.range_m < depth + half_depth + config_.margin_m) continue;
    hidden = true;
    const double width = 2.0 * (half_width + blur) * m.range_m / depth;
    density += o.weight * config_.hidden_ghost_density *
               gaussian(m.rate_mps - m.direction.dot(o.velocity_mps), square(kHiddenRate_mps));
    density +=
        o.weight * by_mirrors(i, o.position_m, std::hypot(config_.extent_std_m, 0.5 * half_depth), width,
                              [&](const Eigen::Vector2d& q, double known, const Mirror&, const Eigen::Vector2d&) {
                                const double variance = q.dot(o.velocity_covariance * q) + noise +
                                                        square(0.05) * o.velocity_mps.squaredNorm();
                                return gaussian(m.rate_mps - known - q.dot(o.velocity_mps), variance);
                              });
  }
  // A nearer detection in the same direction will do as well: it is what the tracker has not confirmed yet.
  double most = 0.0;
  const std::size_t own = s_.movers->earlier();
  for (std::size_t k = own; k < s_.movers->size(); ++k) {
    const Mover& mover = (*s_.movers)[k];
    if (mover.index == index) continue;
    const Eigen::Vector2d direction = s_.odometry->vector_to_vehicle(mover.direction);
    if (direction.dot(m.direction) < 0.9) continue;
    const double angle = std::abs(direction.dot(left_of(m.direction)));
    const Eigen::Vector2d target = s_.odometry->point_to_vehicle(mover.position_m);
    const double range = (target - s_.sensor_m).norm();
    if (range + 1.5 + config_.margin_m > m.range_m) continue;
    if (angle > 3.0 * m.azimuth_std_rad + 1.0 / range) continue;
    const double width = 2.0 * m.range_m * (1.5 * m.azimuth_std_rad + 1.0 / range);
    const double fits =
        by_mirrors(Judge::kMaxObjects + mover.index, target, 0.5 * config_.extent_std_m, width,
                   [&](const Eigen::Vector2d& q, double known, const Mirror& mirror, const Eigen::Vector2d&) {
                     const Eigen::Vector2d tangent = mirror.curve.tangent_at(mirror.curve.arc(target));
                     return rate_density(m.rate_mps - known, q, direction, mover.rate_mps, noise, tangent, noise);
                   });
    most = std::max(most, mover.weight * fits);
  }
  return density + most;
}

Densities Judge::weigh(const Measured& m, std::uint32_t index, std::uint32_t but_object) {
  Densities densities;
  double behind = 0.0;
  for (const Mirror& mirror : s_.mirrors) {
    const auto turn = turn_at(mirror, s_.sensor_m, m.direction, m.range_m - config_.margin_m, m.azimuth_std_rad);
    if (!turn) continue;
    behind = std::max(behind, turn->probability);
    densities.type2 += type2(m, mirror, *turn, but_object);
  }
  bool hidden = false;
  densities.type1 = type1(m, index, but_object, hidden);
  if (but_object != kNobody) return densities;
  const bool company = has_company(m, index);
  densities.moving = of_objects(m, but_object) +
                     config_.new_object_density * (company ? 5.0 : 0.4) * (1.0 - 0.7 * behind) * (hidden ? 0.5 : 1.0);
  // Clutter is weak: thermal noise just over the threshold.
  const double weak =
      std::isfinite(m.rcs_dbsm) ? 0.1 + 1.9 / (1.0 + std::exp((m.rcs_dbsm - config_.weak_rcs_dbsm) / 4.0)) : 1.0;
  densities.clutter = config_.clutter_density * weak * (company ? 0.1 : 1.0);
  // Each bounce costs power, so that ghosts are weaker than vehicles; never so surely that this alone decides.
  if (std::isfinite(m.rcs_dbsm)) {
    densities.moving *= 0.15 + 1.0 / (1.0 + std::exp((config_.weak_rcs_dbsm - m.rcs_dbsm) / 4.0));
    const double ghostly = 0.15 + 1.0 / (1.0 + std::exp((m.rcs_dbsm - config_.strong_rcs_dbsm) / 4.0));
    densities.type1 *= ghostly;
    densities.type2 *= ghostly;
  }
  densities.stationary = of_stationary(m);
  return densities;
}

Densities Judge::weigh_still(const Measured& m) {
  Densities densities;
  densities.moving = of_objects(m, kNobody);
  densities.stationary = of_stationary(m);
  if (is_known_still(m)) return densities;
  // The image of a vehicle may look as if it stood, when it crosses the line of sight.
  for (const Mirror& mirror : s_.mirrors) {
    const auto turn = turn_at(mirror, s_.sensor_m, m.direction, m.range_m - config_.margin_m, m.azimuth_std_rad);
    if (turn) densities.type2 += type2(m, mirror, *turn, kNobody);
  }
  return densities;
}

}  // namespace boresight::ghosts
