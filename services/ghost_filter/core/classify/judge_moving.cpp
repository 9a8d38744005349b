// Direct reflections of tracked objects.
#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/classify/judge.hpp"
#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

/// Vehicles do not reach through rails, but are seen above them.
constexpr double kSeenThrough = 0.03;
/// Of what as likely stands, and of what is hardly known to be there, nothing looks stationary that is not.
constexpr double kLeastMoving = 0.6, kLeastThere = 0.5;
/// What goes together is so near, and so alike in range rate.
constexpr double kCompany_m = 3.0, kCompany_mps = 1.5;

/// Detections in a scan. From where a car's box may end to where it hardly does, an object is more likely a truck. Of
/// one that is longer than a box van each metre shows as much as of that: it has more axles.
double expected_of(const Object& object, const ClassConfig& config) {
  constexpr double kMayBeTruck_m = 4.7, kIsTruck_m = 5.3, kIsLong_m = 8.0;
  const double length_m = 2.0 * object.half_length_m;
  const double share = std::clamp((length_m - kMayBeTruck_m) / (kIsTruck_m - kMayBeTruck_m), 0.0, 1.0);
  return (config.real_per_object + share * (config.real_per_truck - config.real_per_object)) *
         std::max(1.0, length_m / kIsLong_m);
}

}  // namespace

void Judge::of_objects(const Measured& m, bool looks_still, Densities& densities) const {
  double most = 0.0;
  const Eigen::Matrix2d covariance = outer(m.direction, square(m.range_std_m) + square(0.2)) +
                                     outer(left_of(m.direction), square(m.range_m * m.azimuth_std_rad) + square(0.2));
  const double blur_m = reach_of(covariance.diagonal());
  const auto judge = [&](std::uint32_t i) {
    const Object& o = s_.objects[i];
    if (o.own || (o.position_m - m.position_m).squaredNorm() > square(o.reach_m + 1.5 * blur_m)) return;
    if (looks_still && (o.moving < kLeastMoving || o.weight < kLeastThere)) return;
    const Reflections place = reflections_at(o, m.position_m, covariance, s_.sensor_m, s_.sensor_m);
    if (place.wheel <= 0.0) return;
    double seen = 1.0;
    for (const Crossing& crossing : crossings_) {
      const double sensor_side = crossing.mirror->curve.distance(s_.sensor_m);
      if (crossing.mirror->body == i || crossing.mirror->curve.distance(o.position_m) * sensor_side <= 0.0) continue;
      seen *= 1.0 - (1.0 - kSeenThrough) * crossing.sure();
    }
    const RateDensity rates = rates_at(o, m.rate_mps, m.direction, rate_variance(m));
    const double above_db = m.rcs_dbsm - o.rcs_dbsm, doubt = config_.strength_doubt;
    const double weight = o.weight * (looks_still ? o.moving : 1.0);
    const double expected = expected_of(o, config_);
    const double all = weight * expected * seen;
    const double of_whole = expected * (1.0 - config_.wheel_share) * place.body * rates.body *
                            likelihood(kBodyStrength, above_db, o.rcs_std_db, doubt);
    const double of_all = weight * seen * of_whole + all * config_.wheel_share * place.wheel * rates.wheel *
                                                         likelihood(kWheelStrength, above_db, o.rcs_std_db, doubt);
    densities.moving += of_all;
    if (of_all > most) {
      most = of_all;
      densities.likeliest = i;
    }
    // The detections of an image are where it is tracked, as those of an object are.
    densities.of_images += o.image * of_whole;
    // Whether it is one or the other, its strength is learnt: that tells which.
    if (const double of_either = (o.weight + o.image) * of_whole; of_either > densities.of_body) {
      densities.of_body = of_either;
      densities.object = i;
    }
  };
  SourceMap::visit_objects(s_.sources->objects_about(m.position_m, blur_m),
                           static_cast<std::uint32_t>(s_.objects.size()), judge);
  densities.of_tracks = densities.moving;
}

Judge::Owner Judge::owner_of(const Measured& m) const {
  constexpr double kAround_m = 1.0, kOff = 4.0;
  Owner owner;
  double real = 1.0;
  bool is_found = false;
  const auto look = [&](std::uint32_t i) {
    const Object& o = s_.objects[i];
    const bool is_image = o.image > o.weight;
    if (is_found || o.own || (o.weight < 0.5 && !is_image) || !is_on(o, m.position_m, kAround_m)) return;
    const double variance = rate_variance(m) + m.direction.dot(o.velocity_covariance * m.direction);
    const bool is_off = square(m.rate_mps - m.direction.dot(o.velocity_mps)) > square(kOff) * variance;
    if (is_image) {
      if (!is_off) real = std::min(real, o.weight / (o.weight + o.image));
      return;
    }
    owner = {i, is_off};
    is_found = !owner.is_wheel;
  };
  SourceMap::visit_objects(s_.sources->objects_about(m.position_m, kAround_m),
                           static_cast<std::uint32_t>(s_.objects.size()), look);
  if (owner.object == kNobody) owner.real = real;
  return owner;
}

Judge::Recent Judge::of_movers(const Measured& m, std::uint32_t index) const {
  Recent recent{0.0, false};
  double most_now = 0.0, most_before = 0.0;
  const Eigen::Vector2d place = s_.odometry->point_to_frame(m.position_m);
  const Eigen::Vector2d direction = s_.odometry->vector_to_frame(m.direction);
  const std::int64_t now_ns = s_.odometry->now_ns();
  const std::size_t own = s_.movers->earlier();
  const double blur = square(m.range_std_m) + square(m.range_m * m.azimuth_std_rad) + square(config_.extent_std_m);
  const double most_of_strength =
      std::isfinite(m.rcs_dbsm) ? likelihood(kBodyStrength, 0.0, 0.0, config_.strength_doubt) : 1.0;
  const double least_noise = rate_variance(m) + square(m.rate_std_mps);
  const double most_of_rest = most_of_strength / (2.0 * M_PI * std::sqrt(2.0 * M_PI * least_noise));
  s_.movers->near(place, [&](const Mover& mover, std::uint32_t number) {
    if (number >= own && mover.index == index) return;
    const double elapsed_s = static_cast<double>(now_ns - mover.time_ns) * 1e-9;
    const Eigen::Vector2d moved = mover.position_m + elapsed_s * mover.rate_mps * mover.direction;
    const double distance2 = (moved - place).squaredNorm();
    const bool is_now = elapsed_s <= config_.memory_s;
    double& most = is_now ? most_now : most_before;
    recent.in_company = recent.in_company || (is_now && distance2 <= square(kCompany_m) &&
                                              std::abs(mover.rate_mps - m.rate_mps) < kCompany_mps);
    const double variance = blur + mover.variance_m2 + square(8.0 * elapsed_s);
    const double chi2 = distance2 / variance;
    // What a track stands for weighs nothing, and on a busy road that is most.
    if (chi2 > 16.0 || mover.weight * most_of_rest <= most * variance) return;
    // The same velocity shows another range rate from another direction: by the speed across, which is not known.
    const double turn = 1.0 - square(direction.dot(mover.direction));
    const double noise = least_noise + square(15.0) * std::max(0.0, turn);
    // Even the best strength would not make it the likeliest.
    const double here = mover.weight * exponential(-0.5 * chi2) / (2.0 * M_PI * variance) *
                        gaussian(m.rate_mps - mover.rate_mps, noise);
    if (here * most_of_strength <= most) return;
    // Of how strong it may be a track knows more than what is usual.
    const bool owned = number >= own && mover.object != kNobody;
    const double rcs_dbsm = owned ? s_.objects[mover.object].rcs_dbsm : kUsualRcs_dbsm;
    const double rcs_std_db = owned ? s_.objects[mover.object].rcs_std_db : kUsualRcsStd_db;
    most = std::max(most, here * likelihood(kBodyStrength, m.rcs_dbsm - rcs_dbsm, rcs_std_db, config_.strength_doubt));
  });
  // What was judged just now knows what was seen before, and ghosts are seen in every scan.
  const double most = recent.in_company ? most_now : std::max(most_now, most_before);
  recent.density = config_.real_per_object * (1.0 - config_.wheel_share) * most;
  return recent;
}

}  // namespace boresight::ghosts
