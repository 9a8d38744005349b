// Type-1 ghosts: the last bounce was on the target, so that they lie in its direction, behind it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "services/ghost_filter/core/classify/judge.hpp"
#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kHiddenRate_mps = 5.0;      // by which a ghost's range rate differs from its object's
constexpr double kLeastTargetRange_m = 0.5;  // of the target from the sensor
constexpr double kLeastDetour_m = 0.3;
/// Share of ghosts whose very spot was detected directly; of the others another spot of the same vehicle was.
constexpr double kSameSpot = 0.6;
constexpr double kSpot_m = 0.2;  // how large a spot is
constexpr double kFar = 3.0;     // standard deviations, beyond which another spot is not of the same vehicle
constexpr double kLeastShown_mps = 1.0;
constexpr double kLeastWall = 0.3;  // of each of two mirrors being there: waves go to and fro between walls
/// Of a straight mirror's way: a bent one's may stretch so much more, or, where that is not known, so much.
constexpr double kMargin = 1.2, kMostStretch = 10.0;
constexpr double kMostStretchOfAny = std::max(kMostStretch, 2.0 * kMargin * kMostMetresPerM);

}  // namespace

bool Judge::shows_rate(const Object& object) const {
  const Eigen::Vector2d sight = object.position_m - s_.sensor_m;
  return square(sight.dot(object.velocity_mps)) > square(kLeastShown_mps) * sight.squaredNorm();
}

bool Judge::may_be_unheard(const Object& object) const {
  return !object.own && object.weight >= RecentMovers::kLeastWeight &&
         (config_.type1_unheard > 0.0 || !shows_rate(object));
}

void Judge::find_fronts(const Measured& m, std::uint32_t index) {
  fronts_.clear();
  const double extent2 = square(config_.extent_std_m), azimuth2 = square(m.azimuth_std_rad);
  const Eigen::Vector2d left = left_of(m.direction);
  const double most_of_rest = config_.type1_per_object / std::sqrt(2.0 * M_PI * rate_variance(m)) *
                              (std::isfinite(m.rcs_dbsm) ? most_of_strength_ : 1.0);
  // Of what is nearer than half as far, only what lies in the same direction more closely.
  const double angle = 2.0 * kFar * std::sqrt(extent2 / square(m.range_m) + azimuth2);
  s_.echoes->near(m.direction, angle, [&](const DirectEcho& echo) {
    // Written so that what is not measured is not too weak.
    if (m.rcs_dbsm > echo.rcs_dbsm || echo.index == index || echo.weight < RecentMovers::kLeastWeight) return;
    const double depth_m = echo.range_m * echo.direction.dot(m.direction);
    if (depth_m < kLeastTargetRange_m || depth_m > m.range_m + kFar * config_.extent_std_m) return;
    const double beside_m = echo.range_m * echo.direction.dot(left);
    const double across2 = square(depth_m) * (echo.azimuth_variance_rad2 + azimuth2);
    if (square(beside_m) > square(kFar) * (across2 + extent2) || fronts_.size() == fronts_.capacity()) return;
    const double same = kSameSpot * gaussian(beside_m, across2 + square(kSpot_m));
    const double other = (1.0 - kSameSpot) * gaussian(beside_m, across2 + extent2);
    const double most =
        (same / kSpot_m + other / config_.extent_std_m) / std::sqrt(2.0 * M_PI) * echo.weight * most_of_rest;
    fronts_.push_back({&echo, depth_m, kFar * std::sqrt(echo.range_variance_m2 + extent2), same, other, most});
  });
  if (unheard_ == 0) return;
  const SectorSet around = sectors_about(m.direction, kFar * m.azimuth_std_rad);
  if ((unheard_ & around) == 0) return;
  for (const Object& o : s_.objects) {
    if ((o.sectors & around) == 0 || !may_be_unheard(o) || fronts_.size() == fronts_.capacity()) continue;
    const Eigen::Vector2d sight = o.position_m - s_.sensor_m;
    const double depth_m = sight.dot(m.direction), beside_m = sight.dot(left);
    if (depth_m - o.reach_m > m.range_m || depth_m + o.reach_m < 0.0) continue;
    if (std::abs(beside_m) > o.reach_m + kFar * depth_m * m.azimuth_std_rad) continue;
    fronts_.push_back({nullptr, depth_m, o.reach_m, 0.0, 0.0, 0.0});
  }
}

Judge::Ahead Judge::of_all_fronts() const {
  Ahead all{0.0, false};
  for (const Front& front : fronts_) {
    all.most += front.most;
    all.silent = all.silent || front.echo == nullptr;
  }
  return all;
}

Judge::Ahead Judge::ahead_on(const Approach& way, const Measured& m, const Ahead& all) const {
  if (!std::isfinite(way.error_m)) return {all.most * kMostStretch, all.silent};
  const double blur_m = way.error_m + kFar * way.metres_per_m * (2.0 * m.range_std_m + way.length_std_m);
  Ahead ahead{0.0, false};
  for (const Front& front : fronts_) {
    if (std::abs(front.depth_m - way.rest_m) > front.reach_m + blur_m) continue;
    ahead.most += front.most;
    ahead.silent = ahead.silent || front.echo == nullptr;
  }
  // It is known how much a place behind the target stretches there.
  ahead.most *= 2.0 * kMargin * way.metres_per_m;
  return ahead;
}

double Judge::of_fronts(const Target& t, double along2, const Measured& m) const {
  const double rest_m = (t.place_m - s_.sensor_m).dot(m.direction);
  const double blur_m = kFar * std::sqrt(along2);
  const StrengthLikelihood of_heard(t.strength, kFluctuation_db, config_.strength_doubt);
  double sum = 0.0;
  for (const Front& front : fronts_) {
    const double off_m = front.depth_m - rest_m;
    if (front.echo == nullptr || std::abs(off_m) > front.reach_m + blur_m) continue;
    const DirectEcho& echo = *front.echo;
    if (echo.object != kNobody && echo.object == t.mirror->body) continue;  // nothing is seen in its own side
    const double off2 = along2 + echo.range_variance_m2;
    const double there = front.same_spot * gaussian(off_m, off2 + square(kSpot_m)) +
                         front.other_spot * gaussian(off_m, off2 + square(config_.extent_std_m));
    sum += echo.weight * there * strength_beside(of_heard, t, m, echo.rcs_dbsm) *
           rate_fits(t, m, echo.object, echo.direction, echo.rate_mps);
  }
  return sum;
}

double Judge::variance_along(const Measured& m, const Meeting& met) {
  return square(met.metres_per_m) * (square(2.0 * m.range_std_m) + square(met.length_std_m));
}

Judge::Target Judge::target_of(const Measured& m, const Meeting& met, double along2, const Mirror& mirror) const {
  Target t{};
  t.other_body = kNobody;
  t.place_m = s_.sensor_m + met.rest_m * m.direction;
  t.covariance = outer(m.direction, along2) + outer(left_of(m.direction), square(met.rest_m * m.azimuth_std_rad));
  t.q = 0.5 * (m.direction + met.arrival);
  t.known_mps = 0.5 * (m.direction - met.departure).dot(s_.sensor_velocity_mps);
  t.noise_variance = rate_variance(m);
  t.lit_from_m = met.point_m;
  t.seen_from_m = s_.sensor_m;
  t.sight = m.direction;
  t.stretch = 2.0 * met.metres_per_m * met.rest_m / m.range_m;
  t.turn_variance = square(m.azimuth_std_rad);
  t.mirror = &mirror;
  return t;
}

double Judge::type1(const Measured& m, std::uint32_t index, std::uint32_t but_object, double least) {
  // What reflects to the radar by way of a mirror reflects directly, too, and stronger: it was detected, in front. Of a
  // track, which is no detection, that is not asked: it may be out of this radar's sight.
  const bool is_track = but_object != kNobody;
  if (!is_track) {
    find_fronts(m, index);
    if (fronts_.empty()) return 0.0;
  }
  const Ahead in_all = of_all_fronts();
  const double most = kMostStretchOfAny * in_all.most;
  double density = 0.0;
  for (const WaysBy& ways : ways_) {
    const Mirror& mirror = ways.mirror();
    // Of those that follow it is the less so.
    if (!is_track && !in_all.silent && mirror.existence * most <= std::max(density, least)) break;
    if (is_track && mirror.body == but_object) continue;
    // The way out and back is no shorter than to the mirror and back.
    if (mirror.least_range_m > m.range_m || !mirror.beam.may_light_before(m.position_m)) continue;
    const auto way = ways.approach(m.direction, 2.0 * m.range_m);
    if (!way) continue;
    const Ahead ahead =
        is_track ? Ahead{0.0, may_be_at(s_.sensor_m, m.direction, *way, m, square(way->rest_m * m.azimuth_std_rad))}
                 : ahead_on(*way, m, in_all);
    if (!ahead.silent && mirror.existence * ahead.most <= std::max(density, least)) continue;
    const auto met = ways.meet(way->arc_m, s_.sensor_m, m.direction, 2.0 * m.range_m, kLeastTargetRange_m);
    if (!met || met->rest_m > m.range_m - kLeastDetour_m || met->probability < kLeastChance) continue;
    const double along2 = variance_along(m, *met);
    Target t = target_of(m, *met, along2, mirror);
    t.known_mps += 0.5 * (met->departure - met->arrival).dot(mirror.velocity_mps);
    t.strength = strength_of_ghost(1, m.direction.dot(met->arrival));
    t.silent = !is_track;
    const double share = met->probability * config_.type1_per_object;
    double here = is_track ? 0.0 : t.stretch * of_fronts(t, along2, m);
    if (ahead.silent) here += ghosts_of(t, m, but_object, index, std::max(density, least) / share);
    density = std::max(density, share * here);
  }
  return density;
}

bool Judge::is_behind_alongside() const {
  constexpr double kAlongside_m = 10.0;
  return std::any_of(fronts_.begin(), fronts_.end(), [](const Front& front) { return front.depth_m < kAlongside_m; });
}

void Judge::find_walls() {
  if (std::exchange(walls_are_found_, true)) return;
  walls_.clear();
  sides_.clear();
  for (const Mirror* const mirror : likely_) {
    if (mirror->existence < kLeastWall) break;  // the likeliest ones come first
    if (!is_long(*mirror)) continue;
    const Eigen::Vector2d side_m = mirror->curve.distance(s_.sensor_m) * mirror->curve.normal();
    for (const Side& other : sides_) {
      if (mirror->existence * other.mirror->existence < kLeastPair || walls_.capacity() - walls_.size() < 2) break;
      // To be between them is to have them on different sides.
      if (side_m.dot(other.side_m) >= 0.0) continue;
      walls_.emplace_back(*mirror, *other.mirror, s_.sensor_m);
      walls_.emplace_back(*other.mirror, *mirror, s_.sensor_m);
    }
    sides_.push_back({mirror, side_m});
  }
}

double Judge::type1_of_two(const Measured& m, double least) {
  if (fronts_.empty()) return 0.0;
  find_walls();
  double density = 0.0;
  for (const WaysBetween& ways : walls_) {
    if (ways.least_range_m() > m.range_m) continue;
    if (walls_left_of_scan_ == 0) return density;
    --walls_left_of_scan_;
    const auto met = ways.meet(m.direction, 2.0 * m.range_m);
    if (!met || met->rest_m < kLeastTargetRange_m || met->rest_m > m.range_m - kLeastDetour_m) continue;
    if (met->probability < kLeastChance) continue;
    const double along2 = variance_along(m, *met);
    Target t = target_of(m, *met, along2, ways.second());
    t.strength = strength_of_ghost(2, m.direction.dot(met->arrival));
    t.silent = true;
    const double share = met->probability * config_.type1_per_object;
    const double more = std::max(density, least) / share;
    density =
        std::max(density, share * (t.stretch * of_fronts(t, along2, m) + ghosts_of(t, m, kNobody, kNobody, more)));
  }
  return density;
}

double Judge::hidden(const Measured& m, std::uint32_t but_object, bool& is_hidden) const {
  double density = 0.0;
  is_hidden = false;
  const SectorSet around = sectors_about(m.direction, kFar * m.azimuth_std_rad);
  for (std::uint32_t i = 0; i < s_.objects.size(); ++i) {
    const Object& o = s_.objects[i];
    if ((o.sectors & around) == 0 || i == but_object || o.own || o.weight < 0.05) continue;
    const Eigen::Vector2d sight = o.position_m - s_.sensor_m;
    const double depth = sight.dot(m.direction), beside = std::abs(sight.dot(left_of(m.direction)));
    if (depth < 1.0 || depth > m.range_m) continue;
    const double along = std::abs(o.axis.dot(m.direction)), across = std::abs(o.axis.dot(left_of(m.direction)));
    const double half_depth = o.half_length_m * along + o.half_width_m * across;
    const double half_width = o.half_length_m * across + o.half_width_m * along;
    const double blur = depth * m.azimuth_std_rad;
    if (beside > half_width + 2.0 * blur + 0.3 || m.range_m < depth + half_depth + config_.margin_m) continue;
    is_hidden = true;
    density += o.weight * config_.hidden_ghost_density *
               gaussian(m.rate_mps - m.direction.dot(o.velocity_mps), square(kHiddenRate_mps)) *
               likelihood(kGhostStrength, m.rcs_dbsm - o.rcs_dbsm, o.rcs_std_db, config_.strength_doubt);
  }
  return density;
}

}  // namespace boresight::ghosts
