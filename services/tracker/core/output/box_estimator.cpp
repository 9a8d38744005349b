#include "services/tracker/core/output/box_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "services/common/extended_object/detection_count.hpp"
#include "services/common/extended_object/reflection_model.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

using extended_object::kRoadUserClasses;
using extended_object::ObjectClassModel;

constexpr double kUnlikely = 1e-3;  // classes below it are not computed

Eigen::Matrix2d rotation(double heading_rad) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  Eigen::Matrix2d r;
  r << c, -s, s, c;
  return r;
}

Eigen::Matrix2d eigen(const Symmetric2<double>& s) {
  Eigen::Matrix2d m;
  m << s.xx, s.xy, s.xy, s.yy;
  return m;
}

/// log p(n) of the gamma-Poisson distribution.
double log_count(const extended_object::DetectionCount& model, double mean, double n) {
  const double k = model.dispersion_shape;
  return std::lgamma(k + n) - std::lgamma(k) - std::lgamma(n + 1.0) + k * std::log(k / (k + mean)) +
         n * std::log(mean / (k + mean));
}

}  // namespace

BoxMemory BoxEstimator::begin() const {
  BoxMemory m;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    m.classes[k].length_m = table_[k].size.length_mean_m;
    m.classes[k].length_variance_m2 = table_[k].size.length_std_m * table_[k].size.length_std_m;
  }
  return m;
}

void BoxEstimator::follow_course(BoxMemory& m, const Component<double>& o, double elapsed_s) const {
  const double speed_mps = std::sqrt(squared_norm(o.velocity_mps));
  const double time_s = std::max(0.0, elapsed_s);
  // At rest nothing turns.
  const double moving = speed_mps / (speed_mps + 1.0);
  m.heading_variance_rad2 += parameters_.turn_rate_std_radps * parameters_.turn_rate_std_radps * time_s * moving;
  if (speed_mps <= 0.0) return;
  const Vector2<double> across{-o.velocity_mps.y / speed_mps, o.velocity_mps.x / speed_mps};
  const double slip = parameters_.side_slip_mps;
  const double variance = (quadratic(o.velocity_covariance, across) + slip * slip) / (speed_mps * speed_mps);
  // Successive courses share their errors: the surer one counts, they are not averaged.
  if (variance < m.heading_variance_rad2) {
    m.heading_rad = std::atan2(o.velocity_mps.y, o.velocity_mps.x);
    m.heading_variance_rad2 = variance;
  }
  const Vector2<double> along{o.velocity_mps.x / speed_mps, o.velocity_mps.y / speed_mps};
  m.largest_speed_mps =
      std::max(m.largest_speed_mps, speed_mps - 2.0 * std::sqrt(quadratic(o.velocity_covariance, along)));
}

std::array<double, kRoadUserClasses> BoxEstimator::probabilities(const BoxMemory& m) const {
  std::array<double, kRoadUserClasses> p{};
  double best = -1e300;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const ObjectClassModel& c = table_[k];
    const double sigma = c.motion.birth_speed_std_mps, speed = m.largest_speed_mps;
    // Speeds of a class are normal about zero in each direction, up to the largest.
    const double of_speed = -2.0 * std::log(sigma) - 0.5 * speed * speed / (sigma * sigma);
    const double over = std::max(0.0, speed - c.motion.largest_speed_mps);
    p[k] = std::log(c.prior_share) + of_speed - over * over + m.classes[k].log_evidence;
    best = std::max(best, p[k]);
  }
  double sum = 0.0;
  for (double& x : p) sum += x = std::exp(x - best);
  for (double& x : p) x /= sum;
  return p;
}

void BoxEstimator::update(BoxMemory& m, const Component<double>& o, const BoxObservation& scan) const {
  follow_course(m, o, scan.elapsed_s);
  const double keep = std::exp(-std::max(0.0, scan.elapsed_s) / parameters_.forget_s);
  for (ClassBox& c : m.classes) c.log_evidence *= keep;
  if (scan.detections <= 0.0) return;
  const auto p = probabilities(m);
  const Eigen::Matrix2d to_local = rotation(m.heading_rad);
  const Eigen::Vector2d from_reflections(scan.sensor_m.x - o.position_m.x, scan.sensor_m.y - o.position_m.y);
  const double range_m = from_reflections.norm();
  const Eigen::Matrix2d noise = to_local.transpose() * eigen(scan.noise_m2) * to_local;
  const Eigen::Matrix2d scatter = to_local.transpose() * eigen(scan.scatter) * to_local;
  double top = -1e300;
  std::array<double, kRoadUserClasses> log_p{};
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    log_p[k] = 0.0;
    if (p[k] < kUnlikely) continue;
    ClassBox& c = m.classes[k];
    const ObjectClassModel& model = table_[k];
    const Eigen::Vector2d sensor_box = to_local.transpose() * from_reflections + c.offset_m;
    const auto moments =
        extended_object::reflection_moments(model.places, c.length_m, model.size.width_mean_m, sensor_box,
                                            {std::sqrt(c.length_variance_m2), model.size.width_std_m}, scan.detections);
    const double gain = c.has_offset ? parameters_.offset_gain : 1.0;
    c.offset_m += gain * (moments.mean_m - c.offset_m);
    c.offset_covariance_m2 = moments.lasting_m2;
    c.has_offset = true;

    const double expected = extended_object::expected_detections(model.count, range_m, sensor_box.normalized());
    log_p[k] = log_count(model.count, expected, scan.detections) -
               std::log(1.0 - extended_object::no_detection_probability(model.count, expected));
    constexpr double kPair = 1.5;
    if (scan.detections > kPair) {
      const Eigen::Matrix2d s = moments.scatter_m2 + noise;
      const double dof = scan.detections - 1.0;
      log_p[k] -= 0.5 * (s.inverse() * scatter).trace() + 0.5 * dof * std::log(s.determinant());
      // Length from the scatter along the heading, which grows with its square.
      const double measured = std::max(0.0, scatter(0, 0) / dof - noise(0, 0));
      const double shape = moments.scatter_m2(0, 0) / (c.length_m * c.length_m);
      if (shape > 0.0) {
        const double slope = 2.0 * shape * c.length_m;
        const double variance =
            2.0 * s(0, 0) * s(0, 0) / dof / parameters_.evidence_share + slope * slope * c.length_variance_m2;
        const double k_gain = c.length_variance_m2 * slope / variance;
        c.length_m =
            std::max(0.3 * model.size.length_mean_m, c.length_m + k_gain * (measured - moments.scatter_m2(0, 0)));
        c.length_variance_m2 *= 1.0 - k_gain * slope;
      }
    }
    top = std::max(top, log_p[k]);
  }
  // Classes that are not computed keep their distance.
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    if (p[k] >= kUnlikely) m.classes[k].log_evidence += parameters_.evidence_share * (log_p[k] - top);
  }
}

Box BoxEstimator::box(const BoxMemory& m, const Component<double>& o) const {
  Box out;
  out.probability = probabilities(m);
  out.heading_rad = m.heading_rad;
  constexpr double kUniform = std::numbers::pi * std::numbers::pi / 3.0;
  out.heading_variance_rad2 = std::min(m.heading_variance_rad2, kUniform);
  const Eigen::Matrix2d to_local = rotation(m.heading_rad);
  const Eigen::Vector2d p(o.position_m.x, o.position_m.y);
  std::array<Eigen::Vector2d, kRoadUserClasses> centre;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const double w = out.probability[k];
    centre[k] = p - to_local * m.classes[k].offset_m;
    out.centre_m += w * centre[k];
    out.length_m += w * m.classes[k].length_m;
    out.width_m += w * table_[k].size.width_mean_m;
    out.height_m += w * table_[k].size.height_m;
  }
  out.covariance_m2 = eigen(o.position_covariance);
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const double w = out.probability[k];
    const ClassBox& c = m.classes[k];
    const Eigen::Vector2d d = centre[k] - out.centre_m;
    const double dl = c.length_m - out.length_m, dw = table_[k].size.width_mean_m - out.width_m;
    // A heading that is wrong turns the offset.
    const Eigen::Vector2d turned = to_local * Eigen::Vector2d(-c.offset_m.y(), c.offset_m.x());
    out.covariance_m2 += w * (d * d.transpose() + to_local * c.offset_covariance_m2 * to_local.transpose() +
                              out.heading_variance_rad2 * turned * turned.transpose());
    out.length_variance_m2 += w * (c.length_variance_m2 + dl * dl);
    out.width_variance_m2 += w * (table_[k].size.width_std_m * table_[k].size.width_std_m + dw * dw);
    out.centre_length_covariance_m2 += w * dl * d;
  }
  return out;
}

}  // namespace boresight::tracking
