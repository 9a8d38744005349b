// Ghosts: a detection is one as far as there is something real where it would have to be, moving as it would have to.
#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/classify/judge.hpp"
#include "services/ghost_filter/core/classify/rate_density.hpp"
#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kLeastRestBehindMirror_m = 0.3;  // behind a mirror
// Of one object's type-2 ghosts by one mirror, shares by the way out: by the same mirror, directly, by another mirror.
constexpr double kSameWay = 0.5, kDirectly = 0.3, kOtherMirror = 0.2;
constexpr double kAround_m = 2.0;  // of a track's box
constexpr double kSame = 0.4;      // share of ghosts whose very reflection was detected directly, too

/// Whether one radar sees in both directions (unit vectors). Vehicles' radars look one way, over 150 degrees at most:
/// none is lit directly by what drives behind it.
bool sees_both(const Eigen::Vector2d& one, const Eigen::Vector2d& other) {
  constexpr double kWidestView = -0.87;  // cosine
  return one.dot(other) > kWidestView;
}

/// Whether something is rather what was detected itself than what that would be a ghost of. Far away, in a mirror
/// almost along the line of sight, both are one place, and a vehicle would be a ghost of what was detected of it just
/// before.
bool is_itself(const Eigen::Vector2d& at_m, const Measured& m, const Eigen::Vector2d& target_m) {
  return (at_m - m.position_m).squaredNorm() < (at_m - target_m).squaredNorm();
}

}  // namespace

double Judge::noise_of_any(const Target& target) {
  constexpr double kAnySpeed_mps = 15.0;
  return target.noise_variance + target.turn_variance * square(kAnySpeed_mps);
}

double Judge::rate_fits(const Target& target, const Measured& m, std::uint32_t object, const Eigen::Vector2d& direction,
                        double rate_mps) const {
  const double value = m.rate_mps - target.known_mps, noise = noise_of_any(target);
  // A track knows the velocity, a single detection one component of it.
  if (object != kNobody) return body_rate_at(s_.objects[object], value, target.q, noise);
  return rate_density(value, target.q, direction, rate_mps, square(config_.range_rate_slack_mps),
                      left_of(target.mirror->curve.normal()), noise);
}

double Judge::strength_beside(const StrengthLikelihood& of_heard, const Target& target, const Measured& m,
                              double rcs_dbsm) const {
  if (std::isfinite(rcs_dbsm)) return of_heard(m.rcs_dbsm - rcs_dbsm);
  return likelihood(target.strength, m.rcs_dbsm - kUsualRcs_dbsm, kUsualRcsStd_db, config_.strength_doubt);
}

double Judge::ghosts_of(const Target& target, const Measured& m, std::uint32_t but_object, std::uint32_t but_index,
                        double least) const {
  least /= target.stretch;
  const Eigen::Matrix2d blurred = target.covariance + square(0.2) * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d reaches_m = reaches_of(blurred.diagonal());
  const double reach_m = reaches_m.maxCoeff();
  const SourceMap::Bits sources = s_.sources->about(target.place_m, reaches_m);
  // However an object reflects: blurred, it is nowhere denser than this.
  const double densest = 1.0 / (2.0 * M_PI * std::sqrt(blurred.determinant()));
  const double along2 = target.sight.dot(blurred * target.sight), along_m = std::sqrt(kFarthest2 * along2);
  double of_tracks = 0.0;
  SourceMap::visit_objects(sources, static_cast<std::uint32_t>(s_.objects.size()), [&](std::uint32_t i) {
    const Object& o = s_.objects[i];
    if (i == but_object || i == target.mirror->body || i == target.other_body || (o.own && !target.of_own)) return;
    // Type-1 ghosts of a long one may lie within it, right behind what they are of.
    if (!target.silent && is_itself(o.position_m, m, target.place_m)) return;
    const Eigen::Vector2d off = o.position_m - target.place_m;
    // A range is known well, and most vehicles are nearer or farther: that takes less than to ask for their range rate.
    if (std::abs(off.dot(target.sight)) > along_m + o.reach_m ||
        off.squaredNorm() > square(1.5 * reach_m + o.reach_m) || is_beyond(o, target.place_m, target.sight, along2))
      return;
    const double weight = o.weight * (target.silent && shows_rate(o) ? config_.type1_unheard : 1.0);
    if (weight <= 0.0) return;
    // Wheels are too weak to be seen in mirrors: what has another range rate than the body is no image of it.
    const double noise = target.noise_variance + target.turn_variance * o.velocity_mps.squaredNorm();
    const double rate = body_rate_at(o, m.rate_mps - target.known_mps, target.q, noise);
    if (weight * rate * densest <= least) return;
    const double anywhere =
        weight * rate * likelihood(target.strength, m.rcs_dbsm - o.rcs_dbsm, o.rcs_std_db, config_.strength_doubt);
    if (anywhere * densest <= least) return;
    of_tracks += anywhere * reflections_at(o, target.place_m, blurred, target.seen_from_m, target.lit_from_m).body;
  });
  if (target.silent) return of_tracks * target.stretch;
  const double enough = std::max(least, kLittle * of_tracks);
  const double of_movers = SourceMap::has_movers(sources) ? of_detected(target, m, but_object, but_index, enough) : 0.0;
  return (of_tracks + of_movers) * target.stretch;
}

double Judge::of_detected(const Target& target, const Measured& m, std::uint32_t but_object, std::uint32_t but_index,
                          double least) const {
  // Several detections are of one object: the best counts.
  double most = least;
  const std::size_t own = s_.movers->earlier();
  const double rate_noise = noise_of_any(target);
  const double most_of_rate = 1.0 / std::sqrt(2.0 * M_PI * rate_noise);
  const StrengthLikelihood of_heard(target.strength, kFluctuation_db, config_.strength_doubt);
  const double spread = target.covariance.trace();
  s_.movers->weighing_near(s_.odometry->point_to_frame(target.place_m), [&](const Mover& mover, const MovedMover& moved,
                                                                            std::uint32_t number) {
    if (number >= own && mover.index == but_index) return;
    const Eigen::Vector2d residual = moved.position_m - target.place_m;
    if (is_itself(moved.position_m, m, target.place_m)) return;
    const double sure = moved.variance_m2;
    if (residual.squaredNorm() > square(kFarMover) * (spread + sure + square(config_.extent_std_m))) return;
    // Of a track that is judged itself, what was detected of it tells nothing.
    if (but_object != kNobody && is_on(s_.objects[but_object], moved.position_m, kAround_m)) return;
    const bool owned = number >= own && mover.object != kNobody;
    if (owned && (mover.object == target.mirror->body || mover.object == target.other_body)) return;
    const double strength = strength_beside(of_heard, target, m, mover.rcs_dbsm);
    const double most_of_rest = mover.weight * strength * most_of_rate;
    const Eigen::Matrix2d eye = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d same = target.covariance + (sure + square(0.2)) * eye;
    // Even at the very place, with the best range rate, it would not be the likeliest.
    if (square(most_of_rest) <= square(2.0 * M_PI * most) * same.determinant()) return;
    const double there =
        kSame * gaussian(residual, same) +
        (1.0 - kSame) * gaussian(residual, target.covariance + (sure + square(config_.extent_std_m)) * eye);
    if (there * most_of_rest <= most) return;
    const double fits = rate_fits(target, m, owned ? mover.object : kNobody, moved.direction, mover.rate_mps);
    most = std::max(most, mover.weight * strength * there * fits);
  });
  return most > least ? most : 0.0;
}

Judge::Target Judge::target_of(const Measured& m, const Crossing& crossing, double rest_m, double metres_per_m) const {
  const Turn& turn = crossing.turn;
  const Eigen::Vector2d& d = turn.direction;
  const double far = turn.distance_m + rest_m;
  const double focus = 1.0 + 2.0 * rest_m * turn.distance_m * turn.focus_per_m / far;
  Target t{};
  t.place_m = turn.point_m + rest_m * d;
  t.covariance =
      outer(d, square(metres_per_m * m.range_std_m)) +
      outer(left_of(d), square(m.azimuth_std_rad * far * focus) + square(2.0 * rest_m * turn.angle_std_rad)) +
      outer(turn.normal, square(2.0 * turn.offset_std_m));
  t.noise_variance = rate_variance(m);
  t.lit_from_m = t.seen_from_m = turn.point_m;
  t.sight = d;
  t.stretch = metres_per_m * far * focus / m.range_m;
  t.turn_variance = square(m.azimuth_std_rad) + square(2.0 * turn.angle_std_rad);
  t.mirror = crossing.mirror;
  t.other_body = kNobody;
  return t;
}

bool Judge::may_be_at(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, const Approach& way,
                      const Measured& m, double variance_across) const {
  constexpr double kMargin = 1.2, kMargin_m = 0.5;  // the way's uncertainty is not the approach's
  const double along = square(way.metres_per_m) * (square(2.0 * m.range_std_m) + square(way.length_std_m));
  const double blur = reach_of(Eigen::Vector2d::Constant(along + variance_across + square(0.2)));
  return s_.sources->about(from_m + way.rest_m * direction, kMargin * blur + kMargin_m + way.error_m) != 0;
}

double Judge::type2(const Measured& m, const Crossing& crossing, std::uint32_t index, std::uint32_t but_object,
                    double least) const {
  const Turn& turn = crossing.turn;
  const double sure = crossing.sure();
  if (!(sure > 0.0)) return 0.0;
  const Eigen::Vector2d& d = turn.direction;
  const double carried = (m.direction - d).dot(crossing.mirror->velocity_mps);
  double density = config_.lone_ghost_density *
                   likelihood(kGhostStrength, m.rcs_dbsm - kUsualRcs_dbsm, kUsualRcsStd_db, config_.strength_doubt);
  if (const double rest = rest_of_three_bounces(turn, m.range_m); rest > kLeastRestBehindMirror_m) {
    Target t = target_of(m, crossing, rest, 1.0);
    t.q = d;
    t.known_mps = carried;
    t.of_own = true;
    t.strength = strength_of_ghost(2, 1.0);
    const double share = kSameWay * config_.type2_per_object;
    density += share * ghosts_of(t, m, but_object, index, least / (share * sure));
  }
  if (const double rest = rest_of_two_bounces(turn, s_.sensor_m, m.range_m); rest > kLeastRestBehindMirror_m) {
    const Eigen::Vector2d e = (turn.point_m + rest * d - s_.sensor_m).normalized();
    // A track may have been seen by another radar than the one from whose place it is judged.
    if (but_object == kNobody && !sees_both(m.direction, e)) return sure * density;
    Target t = target_of(m, crossing, rest, 2.0 / std::max(0.02, 1.0 + d.dot(e)));
    t.q = 0.5 * (d + e);
    t.known_mps = 0.5 * (carried + (m.direction - e).dot(s_.sensor_velocity_mps));
    t.lit_from_m = s_.sensor_m;
    t.strength = strength_of_ghost(1, d.dot(e));
    const double share = kDirectly * config_.type2_per_object;
    density += share * ghosts_of(t, m, but_object, index, least / (share * sure)) + image_of_stationary(t, m);
  }
  return sure * density;
}

double Judge::type2_of_two(const Measured& m, const Crossing& crossing, std::uint32_t index, std::uint32_t but_object,
                           double least) {
  const Turn& turn = crossing.turn;
  const Eigen::Vector2d& d = turn.direction;
  const double sure = crossing.sure();
  if (sure < kLeastPair) return 0.0;
  const double carried = (m.direction - d).dot(crossing.mirror->velocity_mps);
  const double share = kOtherMirror * config_.type2_per_object * sure;
  double density = 0.0;
  // What is reached over there lies at most half of the way off.
  const Eigen::Vector2d farthest_m = turn.point_m + m.range_m * d;
  for (const WaysBy& ways : ways_) {
    const Mirror& other = ways.mirror();
    if (sure * other.existence < kLeastPair) break;  // those that follow are less likely
    if (&other == crossing.mirror || (but_object != kNobody && other.body == but_object) ||
        other.least_range_m > m.range_m || !other.beam.may_light(turn.point_m, farthest_m))
      continue;
    const double length = 2.0 * m.range_m - turn.distance_m;
    const auto way = ways.approach(turn.point_m, d, length);
    if (!way) continue;
    const double far = turn.distance_m + way->rest_m;
    const double across = m.azimuth_std_rad * (far + 2.0 * std::abs(way->rest_m) * turn.distance_m * turn.focus_per_m);
    const double by_mirror = square(2.0 * way->rest_m * turn.angle_std_rad) + square(2.0 * turn.offset_std_m);
    if (!may_be_at(turn.point_m, d, *way, m, square(across) + by_mirror)) continue;
    const auto met = ways.meet(way->arc_m, turn.point_m, d, length, kLeastRestBehindMirror_m);
    if (!met || sure * met->probability < kLeastPair) continue;
    if (pairs_left_ == 0) break;
    --pairs_left_;
    const Eigen::Vector2d& u = met->departure;
    const Eigen::Vector2d& e = met->arrival;
    Target t = target_of(m, crossing, met->rest_m, 2.0 * met->metres_per_m);
    t.covariance += outer(d, square(met->metres_per_m * met->length_std_m));
    t.q = 0.5 * (d + e);
    t.known_mps = 0.5 * (carried + (u - e).dot(other.velocity_mps) + (m.direction - u).dot(s_.sensor_velocity_mps));
    t.lit_from_m = met->point_m;
    t.strength = strength_of_ghost(2, d.dot(e));
    t.other_body = other.body;
    const double more = std::max(density, least / share) / met->probability;
    density = std::max(density, met->probability * ghosts_of(t, m, but_object, index, more));
  }
  return share * density;
}

double Judge::image_of_stationary(const Target& t, const Measured& m) const {
  // What stands still has no range rate of its own: by two bounces it seems to have one, which is known.
  const Eigen::Vector2d sight = t.place_m - s_.sensor_m;
  const double across = left_of(sight.normalized()).dot(t.covariance * left_of(sight.normalized()));
  const double turn_variance = std::min(0.25, across / std::max(1.0, sight.squaredNorm()));
  const double variance = t.noise_variance + 0.25 * turn_variance * s_.sensor_velocity_mps.squaredNorm();
  const bool stands = s_.stationary->index_at(s_.odometry->point_to_frame(t.place_m)) != StationaryGrid::kUnclaimed;
  return (stands ? 1.0 : 0.02) * config_.stationary_image_density * gaussian(m.rate_mps - t.known_mps, variance) *
         likelihood(kGhostStrength, m.rcs_dbsm - kUsualRcs_dbsm, 10.0, config_.strength_doubt);
}

}  // namespace boresight::ghosts
