#include "services/common/extended_object/reflection_model.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/extended_object/range_rate_model.hpp"
#include "services/common/extended_object/truncated_exponential.hpp"

namespace boresight::extended_object {

namespace {

constexpr double kLeastLength_m = 1e-9;     // keeps quotients finite for boxes of size 0
constexpr double kLeastVariance_m2 = 1e-6;  // (1 mm)²: densities of boxes of size 0 without noise stay finite

/// max(0, x), rounded within ±radius: once continuously differentiable, and 0 up to −radius.
double rounded_positive(double x, double radius) {
  if (x <= -radius) return 0.0;
  return x < radius ? (x + radius) * (x + radius) / (4.0 * radius) : x;
}

/// 0 up to −radius, 1 from radius on, once continuously differentiable.
double smooth_step(double x, double radius) {
  const double t = std::clamp(0.5 * (x + radius) / std::max(radius, kLeastLength_m), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Projected length of a face, equation (2). `before_m`: of the sensor before its plane; `along_m`: beside its middle.
double projected_length_m(double face_m, double before_m, double along_m, double radius_m) {
  const double height_m = rounded_positive(before_m, radius_m);
  return face_m * height_m / (Eigen::Vector2d(height_m, along_m).norm() + kLeastLength_m);
}

/// c of equation (3) along an axis of the box.
double mean_cosine(double along_m, double across_m, double half_m) {
  const double ends_m =
      Eigen::Vector2d(along_m + half_m, across_m).norm() + Eigen::Vector2d(along_m - half_m, across_m).norm();
  return 2.0 * along_m / (ends_m + kLeastLength_m);
}

struct PartWeights {
  double end, side, interior;
};
PartWeights part_weights(const ReflectionPlaces& places, const Eigen::Vector2d& half_m,
                         const Eigen::Vector2d& sensor_m) {
  const Eigen::Vector2d before = sensor_m.cwiseAbs() - half_m;
  const Eigen::Vector2d radius = half_m.cwiseMin(places.corner_radius_m);
  const double end = projected_length_m(2.0 * half_m.y(), before.x(), sensor_m.y(), radius.x());
  const double side = projected_length_m(2.0 * half_m.x(), before.y(), sensor_m.x(), radius.y());
  const double in_view =
      1.0 - (1.0 - smooth_step(before.x(), radius.x())) * (1.0 - smooth_step(before.y(), radius.y()));
  const double faces = end + side > 0.0 ? in_view * (1.0 - places.interior_share) / (end + side) : 0.0;
  return {faces * end, faces * side, 1.0 - faces * (end + side)};
}

Eigen::Vector2d mean_of(const SeenMixture& seen) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const ReflectionComponent& c : seen.mixture) mean += c.weight / seen.share * c.mean_m;
  return mean;
}

Eigen::Matrix2d covariance_of(const SeenMixture& seen, const Eigen::Vector2d& mean_m) {
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const ReflectionComponent& c : seen.mixture) {
    const Eigen::Vector2d off = c.mean_m - mean_m;
    covariance += c.weight / seen.share * off * off.transpose();
    covariance.diagonal() += c.weight / seen.share * c.variance_m2;
  }
  return covariance;
}

double normal_density(const Eigen::Vector2d& offset, const Eigen::Matrix2d& covariance) {
  const double xx = covariance(0, 0), yy = covariance(1, 1), xy = 0.5 * (covariance(0, 1) + covariance(1, 0));
  const double determinant = xx * yy - xy * xy, x = offset.x(), y = offset.y();
  const double chi2 = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
  return std::exp(-0.5 * chi2) / (2.0 * M_PI * std::sqrt(determinant));
}

}  // namespace

ReflectionMixture reflection_mixture(const ReflectionPlaces& places, double length_m, double width_m,
                                     const Eigen::Vector2d& sensor_box_m) {
  const Eigen::Vector2d half(0.5 * length_m, 0.5 * width_m);
  const double x = sensor_box_m.x(), y = sensor_box_m.y();
  const PartWeights weights = part_weights(places, half, sensor_box_m);

  const double decay = std::max(places.decay_m, kLeastLength_m);
  const double along_rate = mean_cosine(x, y, half.x()) / decay;
  const MeanVariance across = truncated_exponential(mean_cosine(y, x, half.y()) / decay, half.y());
  const MeanVariance in_part = truncated_exponential(along_rate, half.x() / kLengthParts);
  const Eigen::Vector2d depth = (0.5 * half).cwiseMin(places.face_depth_m);
  const Eigen::Vector2d depth_std = (0.5 * half).cwiseMin(places.face_depth_std_m);

  const auto component = [](double weight, double mean_x, double variance_x, double mean_y, double variance_y) {
    return ReflectionComponent{
        weight, {mean_x, mean_y}, {variance_x + kLeastVariance_m2, variance_y + kLeastVariance_m2}};
  };
  ReflectionMixture mixture;
  mixture[0] = component(weights.end, std::copysign(half.x() - depth.x(), x), depth_std.x() * depth_std.x(),
                         across.mean, across.variance);
  const double side_y = std::copysign(half.y() - depth.y(), y), side_variance = depth_std.y() * depth_std.y();
  const double part_m = length_m / kLengthParts;
  const double next = std::exp(-std::abs(along_rate) * part_m);  // share of a part by that of its nearer neighbour
  const double sum = 1.0 + next + next * next;
  for (std::size_t k = 0; k < kLengthParts; ++k) {
    const std::size_t behind = along_rate > 0.0 ? kLengthParts - 1 - k : k;
    const double share = (behind == 0 ? 1.0 : behind == 1 ? next : next * next) / sum;
    const double mean_x = (static_cast<double>(k) - 1.0) * part_m + in_part.mean;
    mixture[1 + k] = component(share * weights.side, mean_x, in_part.variance, side_y, side_variance);
    mixture[1 + kLengthParts + k] =
        component(share * weights.interior, mean_x, in_part.variance, across.mean, across.variance);
  }
  return mixture;
}

SeenMixture seen_in(const ReflectionMixture& mixture, const Eigen::Vector2d& sensor_box_m, const ViewSector& sector) {
  SeenMixture seen{mixture, 1.0};
  if (sector.half_angle_rad >= M_PI) return seen;
  // Where nothing is in view the moments are those of the part nearest to the edge. Seven deviations from the edge a
  // part is in view or not by 1e-12.
  constexpr double kLeastShare = 1e-9, kSureDeviations = 7.0;
  seen.share = 0.0;
  for (ReflectionComponent& c : seen.mixture) {
    const Eigen::Vector2d way = c.mean_m - sensor_box_m;
    const double range2 = std::max(way.squaredNorm(), kLeastLength_m);
    const double across = (c.variance_m2.x() * way.y() * way.y() + c.variance_m2.y() * way.x() * way.x()) / range2;
    const double std_rad = std::sqrt(sector.edge_rad * sector.edge_rad + across / range2);
    const double ahead = sector.facing.dot(way),
                 aside = std::abs(sector.facing.x() * way.y() - sector.facing.y() * way.x());
    // Most parts are clear of the edge by bounds of their angle: its tangent ahead, a right angle and its sine behind.
    const double sure_rad = kSureDeviations * std_rad;
    if (ahead < 0.0 && 0.5 * M_PI - ahead / std::sqrt(range2) >= sector.half_angle_rad + sure_rad) {
      c.weight *= kLeastShare;
    } else if (ahead <= 0.0 || aside > ahead * (sector.half_angle_rad - sure_rad)) {
      const double beyond_rad = std::atan2(aside, ahead) - sector.half_angle_rad;
      c.weight *= std::max(kLeastShare, 0.5 * std::erfc(beyond_rad / (M_SQRT2 * std_rad)));
    }
    seen.share += c.weight;
  }
  return seen;
}

double position_density(const ReflectionMixture& mixture, const Eigen::Vector2d& point_box_m,
                        const Eigen::Matrix2d& covariance_box_m2) {
  double density = 0.0;
  for (const ReflectionComponent& c : mixture) {
    Eigen::Matrix2d covariance = covariance_box_m2;
    covariance.diagonal() += c.variance_m2;
    density += c.weight * normal_density(point_box_m - c.mean_m, covariance);
  }
  return density;
}

ReflectionMoments reflection_moments(const ReflectionPlaces& places, double length_m, double width_m,
                                     const Eigen::Vector2d& sensor_box_m, const ViewSector& sector) {
  const auto seen_of = [&](double length) {
    return seen_in(reflection_mixture(places, length, width_m, sensor_box_m), sensor_box_m, sector);
  };
  const SeenMixture seen = seen_of(length_m);
  ReflectionMoments result;
  result.share_in_view = seen.share;
  result.mean_m = mean_of(seen);
  result.scatter_m2 = covariance_of(seen, result.mean_m);
  // ∂m/∂L by a step of which neither curvature nor rounding is seen.
  constexpr double kStep_m = 1e-7;
  result.mean_by_length = (mean_of(seen_of(length_m + kStep_m)) - result.mean_m) / kStep_m;
  return result;
}

double held_noise_factor(double scan_correlation) {
  const double rho = std::clamp(scan_correlation, 0.0, 0.99);
  return (1.0 + rho) / (1.0 - rho);
}

double detection_density(const ObjectClassModel& model, const ObservedObject& object, const Eigen::Vector2d& sensor_m,
                         const ObservedDetection& detection) {
  const OrientedBox& box = object.box;
  const Eigen::Matrix2d to_box = box.rotation_to_box();
  const ReflectionMixture places = reflection_mixture(model.places, box.length_m, box.width_m, box.to_box(sensor_m));
  const Eigen::Vector2d sight = line_of_sight(sensor_m, detection.position_m), across(-sight.y(), sight.x());
  const auto rate_along = [&](const Eigen::Vector2d& direction) {
    return rigid_range_rate_mps(direction, sensor_m, box.centre_m, object.velocity_mps, object.turn_rate_radps);
  };
  // (6) is linear in u, so an error of the azimuth enters by the same formula across the line of sight.
  const double range2 = std::max((detection.position_m - sensor_m).squaredNorm(), kLeastLength_m);
  const double azimuth_variance = across.dot(detection.covariance_m2 * across) / range2;
  const double slope = rate_along(across);
  const RangeRateMixture rates =
      range_rate_mixture(model.micro_doppler, to_box * sight, rate_along(sight), object.velocity_mps.norm());
  return position_density(places, box.to_box(detection.position_m),
                          to_box * detection.covariance_m2 * to_box.transpose()) *
         range_rate_density(rates, detection.range_rate_mps,
                            detection.range_rate_variance_m2ps2 + slope * slope * azimuth_variance);
}

}  // namespace boresight::extended_object
