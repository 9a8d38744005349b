#include "services/common/extended_object/range_rate_model.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/extended_object/aspect.hpp"

namespace boresight::extended_object {

namespace {

constexpr double kLeastDistance_m = 1e-9;
constexpr double kLeastVariance_m2ps2 = 1e-8;  // (0.1 mm/s)²: densities without noise stay finite
constexpr int kSidePower = 4;                  // of the sine of the aspect

double weighted_density(const RangeRateComponent& c, double range_rate_mps, double variance_m2ps2) {
  const double variance = c.variance_m2ps2 + variance_m2ps2, off = range_rate_mps - c.mean_mps;
  return c.weight * std::exp(-0.5 * off * off / variance) / std::sqrt(2.0 * M_PI * variance);
}

}  // namespace

Eigen::Vector2d line_of_sight(const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d way = point_m - sensor_m;
  const double range = way.norm();
  return range > kLeastDistance_m ? Eigen::Vector2d(way / range) : Eigen::Vector2d(0.0, 0.0);
}

double rigid_range_rate_mps(const Eigen::Vector2d& sight, const Eigen::Vector2d& sensor_m,
                            const Eigen::Vector2d& centre_m, const Eigen::Vector2d& velocity_mps,
                            double turn_rate_radps) {
  const Eigen::Vector2d r = sensor_m - centre_m;
  return sight.dot(velocity_mps) + turn_rate_radps * (r.x() * sight.y() - r.y() * sight.x());
}

RangeRateMixture range_rate_mixture(const MicroDoppler& model, const Eigen::Vector2d& sight_box, double body_mps,
                                    double speed_mps) {
  const double moving =
      std::clamp(by_aspect(-sight_box, model.rear_share, model.side_share, model.front_share, kSidePower), 0.0, 1.0);
  const double speed2 = speed_mps * speed_mps, full2 = model.full_speed_mps * model.full_speed_mps;
  const double at_speed = speed2 > 0.0 ? speed2 / (speed2 + full2) : 0.0;
  const double body = model.body_std_mps * model.body_std_mps + kLeastVariance_m2ps2;
  const double small = body + model.small_std_mps * model.small_std_mps * at_speed;
  const double ratio_std = model.ratio_std * body_mps;
  return {{{1.0 - moving, body_mps, body},
           {moving * (1.0 - model.large_share), body_mps, small},
           {moving * model.large_share, body_mps + model.ratio_mean * body_mps, small + ratio_std * ratio_std}}};
}

double range_rate_density(const RangeRateMixture& mixture, double range_rate_mps, double variance_m2ps2) {
  double density = 0.0;
  for (const RangeRateComponent& c : mixture) density += weighted_density(c, range_rate_mps, variance_m2ps2);
  return density;
}

double body_probability(const RangeRateMixture& mixture, double range_rate_mps, double variance_m2ps2) {
  const double all = range_rate_density(mixture, range_rate_mps, variance_m2ps2);
  return all > 0.0 ? weighted_density(mixture[0], range_rate_mps, variance_m2ps2) / all : 0.0;
}

RangeRateMoments range_rate_moments(const RangeRateMixture& mixture) {
  RangeRateMoments m;
  for (const RangeRateComponent& c : mixture) m.mean_mps += c.weight * c.mean_mps;
  for (const RangeRateComponent& c : mixture) {
    const double off = c.mean_mps - m.mean_mps;
    m.variance_m2ps2 += c.weight * (c.variance_m2ps2 + off * off);
  }
  return m;
}

}  // namespace boresight::extended_object
