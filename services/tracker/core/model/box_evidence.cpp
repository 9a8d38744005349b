// What a scan tells of an object's class and of the length that it has in each class: number of detections, their
// scatter and their place, and parts that turn out to be its own.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <Eigen/LU>

#include "services/common/extended_object/detection_count.hpp"
#include "services/tracker/core/model/box_estimator.hpp"
#include "services/tracker/core/model/plane_axes.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

using extended_object::kRoadUserClasses;
using extended_object::ObjectClassModel;

namespace {

/// log of the density of a scatter of n detections about their mean, without its constant.
double log_scatter(const Eigen::Matrix2d& scatter, const Eigen::Matrix2d& covariance, double n) {
  return -0.5 * (covariance.inverse() * scatter).trace() - 0.5 * (n - 1.0) * std::log(covariance.determinant());
}

/// log of a normal density without its constant.
double log_normal(const Eigen::Vector2d& e, const Eigen::Matrix2d& covariance) {
  return -0.5 * e.dot(covariance.inverse() * e) - 0.5 * std::log(covariance.determinant());
}

}  // namespace

double BoxEstimator::log_counts(std::size_t k, double n, const ClassBox& box) const {
  const double shape = table_[k].count.dispersion_shape;
  return std::lgamma(shape + n) - prior_[k].log_gamma_of_shape + prior_[k].shape_log_shape -
         (shape + n) * std::log(shape + box.expected) + box.log_expected;
}

void BoxEstimator::weigh_classes(BoxMemory& m) const {
  double best = -1e300, sum = 0.0;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const ObjectClassModel& c = table_[k];
    const double speed = m.largest_speed_mps;
    // Speeds of a class are normal about zero in each direction, up to the largest; some of its objects are slow.
    const auto density = [speed](double sigma) {
      return std::exp(-0.5 * speed * speed / (sigma * sigma)) / (sigma * sigma);
    };
    const double of_speed =
        std::log(kLeastDensity + (1.0 - c.motion.slow_share) * density(c.motion.birth_speed_std_mps) +
                 c.motion.slow_share * density(c.motion.slow_speed_std_mps));
    const double over = std::max(0.0, speed - c.motion.largest_speed_mps);
    m.probability[k] = prior_[k].log_share + of_speed - over * over + m.classes[k].log_evidence +
                       log_counts(k, m.detections, m.classes[k]);
    best = std::max(best, m.probability[k]);
  }
  for (double& x : m.probability) sum += x = std::exp(x - best);
  for (double& x : m.probability) x /= sum;
}

void BoxEstimator::count(BoxMemory& m, double n, const std::array<double, kRoadUserClasses>& expected) const {
  const double share = parameters_.evidence_share;
  m.detections += share * n;
  const auto likeliest = static_cast<std::size_t>(
      std::distance(m.probability.begin(), std::max_element(m.probability.begin(), m.probability.end())));
  std::array<double, kRoadUserClasses> seen{};
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    // There are detections: scans without any may be those where the object was hidden.
    const double m_k = std::max(kLeastProbability, expected[k]);
    seen[k] = m_k / (1.0 - extended_object::no_detection_probability(table_[k].count, m_k));
  }
  const double usual = m.classes[likeliest].expected, now = seen[likeliest];
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    ClassBox& c = m.classes[k];
    // Classes that are not computed keep their ratio.
    const double mean = expected[k] > 0.0 || usual <= 0.0 ? seen[k] : now * c.expected / usual;
    c.log_expected += share * n * std::log(mean);
    c.expected += share * mean;
  }
}

double BoxEstimator::learn_class(ClassBox& box, const ClassView& v, const ObjectClassModel& model,
                                 const BoxObservation& scan, const Eigen::Matrix2d& to_local,
                                 const Eigen::Vector2d& to_sensor_of_point) const {
  const double n = scan.detections;
  const Eigen::Matrix2d noise = to_local.transpose() * eigen(scan.noise_m2) * to_local;
  double log_p = 0.0;
  // Place of the middle, (1).
  const Eigen::Vector2d e = to_local.transpose() * (eigen(scan.mean_m) - eigen(scan.predicted_m)) - v.offset_m;
  const double common = model.places.common_share;
  const Eigen::Matrix2d scatter_of_mean = (common + (1.0 - common) / n) * v.reflections.scatter_m2;
  const Eigen::Matrix2d known =
      to_local.transpose() * eigen(scan.predicted_covariance_m2) * to_local + v.offset_covariance_m2 + noise / n;
  log_p += log_normal(e, known + scatter_of_mean);
  // Length and tracked point are corrected by one innovation, so their errors are correlated from then on: c. The
  // filter corrects the point by its own gain; Joseph form of both. Places are held from scan to scan.
  const Eigen::Vector2d g = v.reflections.mean_by_length - box.point_by_length, c = box.tracked_by_length_m2;
  const double variance = box.length_variance_m2;
  const Eigen::Matrix2d p = to_local.transpose() * eigen(scan.predicted_covariance_m2) * to_local;
  const Eigen::Matrix2d of_filter =
      known + extended_object::held_noise_factor(model.places.scan_correlation) * scatter_of_mean;
  const Eigen::Matrix2d s = of_filter + c * g.transpose() + g * c.transpose();
  const Eigen::Vector2d by_length = c + variance * g, gain = s.inverse() * by_length;
  const Eigen::Matrix2d point_gain = p * of_filter.inverse(), r = of_filter - p - variance * g * g.transpose();
  box.tracked_by_length_m2 = (Eigen::Matrix2d::Identity() - point_gain) * (c - (p + c * g.transpose()) * gain) -
                             point_gain * g * (variance - by_length.dot(gain)) + point_gain * r * gain;
  const double before_m = box.length_m;
  box.length_m = std::max(parameters_.least_length_share * model.size.length_mean_m, before_m + gain.dot(e));
  box.point_m += (box.length_m - before_m) * box.point_by_length;
  // The object's own depth lasts: no number of scans averages it away.
  const double by_depth =
      model.places.lasting_std_m * (v.to_sensor - to_sensor_of_point).dot(g) / std::max(1e-9, g.squaredNorm());
  box.length_variance_m2 = std::min(variance, std::max(variance - by_length.dot(gain), by_depth * by_depth));

  if (n > 1.0) {
    const Eigen::Matrix2d scatter = to_local.transpose() * eigen(scan.scatter) * to_local;
    // From all over the object, or from one third of its length.
    const Eigen::Matrix2d whole = v.reflections.scatter_m2 + noise;
    Eigen::Matrix2d spot = v.reflections.scatter_m2;
    spot.col(0) /= extended_object::kLengthParts;
    spot.row(0) /= extended_object::kLengthParts;
    spot += noise;
    // Now and then one of the detections is not the object's: that speaks against no class.
    const Eigen::Matrix2d with_stray = whole + parameters_.stray_m * parameters_.stray_m * Eigen::Matrix2d::Identity();
    const double of_whole = log_scatter(scatter, whole, n), of_spot = log_scatter(scatter, spot, n),
                 of_stray = log_scatter(scatter, with_stray, n);
    const double top = std::max({of_whole, of_spot, of_stray}), stray = parameters_.stray_share;
    log_p +=
        top + std::log((1.0 - stray) * ((1.0 - common) * std::exp(of_whole - top) + common * std::exp(of_spot - top)) +
                       stray * std::exp(of_stray - top));
  }
  return log_p;
}

void BoxEstimator::learn_without_heading(BoxMemory& m, const BoxObservation& scan) const {
  const double n = scan.detections, noise = 0.5 * trace(scan.noise_m2);
  std::array<double, kRoadUserClasses> log_p{}, counts{};
  double top = -1e300;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const ObjectClassModel& model = table_[k];
    // Seen half from the side.
    const double expected = extended_object::expected_detections(
        model.count, scan.range_m, Eigen::Vector2d(std::numbers::sqrt2 / 2.0, std::numbers::sqrt2 / 2.0));
    const double variance = any_heading_[k].scatter_m2 + noise;
    counts[k] = expected;
    log_p[k] = -0.5 * trace(scan.scatter) / variance - (n - 1.0) * std::log(variance);
    top = std::max(top, log_p[k]);
  }
  count(m, n, counts);
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    m.classes[k].log_evidence += parameters_.evidence_share * (log_p[k] - top);
  }
}

void BoxEstimator::add_part(BoxMemory& m, const Vector2<double>& from_point_m,
                            const Symmetric2<double>& covariance_m2) const {
  const Place part = place(m, from_point_m, covariance_m2);
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    ClassBox& c = m.classes[k];
    c.log_evidence += std::log(std::max(parameters_.least_doubt, inside(m, k, part, {0.0, 0.0})) /
                               (c.length_m * table_[k].size.width_mean_m));
  }
  weigh_classes(m);
}

}  // namespace boresight::tracking
