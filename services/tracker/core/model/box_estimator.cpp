#include "services/tracker/core/model/box_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "services/common/extended_object/detection_count.hpp"
#include "services/common/extended_object/range_rate_model.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

using extended_object::kRoadUserClasses;
using extended_object::ObjectClassModel;

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

Eigen::Vector2d eigen(const Vector2<double>& v) {
  return {v.x, v.y};
}

Eigen::Matrix2d squared(const Eigen::Vector2d& v) {
  return v * v.transpose();
}

/// log of the probability of all counts of an object whose own level is gamma distributed, without terms that all
/// classes share: its level lasts, so that counts alone never make sure of a class.
double log_counts(const extended_object::DetectionCount& model, double n, double expected, double log_expected) {
  const double k = model.dispersion_shape;
  return std::lgamma(k + n) - std::lgamma(k) + k * std::log(k) - (k + n) * std::log(k + expected) + log_expected;
}

/// log of the density of a scatter of n detections about their mean, without its constant.
double log_scatter(const Eigen::Matrix2d& scatter, const Eigen::Matrix2d& covariance, double n) {
  return -0.5 * (covariance.inverse() * scatter).trace() - 0.5 * (n - 1.0) * std::log(covariance.determinant());
}

/// log of a normal density without its constant.
double log_normal(const Eigen::Vector2d& e, const Eigen::Matrix2d& covariance) {
  return -0.5 * e.dot(covariance.inverse() * e) - 0.5 * std::log(covariance.determinant());
}

}  // namespace

BoxEstimator::BoxEstimator(const extended_object::ObjectClassTable& table, const BoxParameters& parameters)
    : table_(table), parameters_(parameters) {
  constexpr double kAfar_m = 1e3;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    AnyHeading& any = any_heading_[k];
    const auto& size = table_[k].size;
    std::array<Eigen::Vector2d, 16> middle;  // of each of so many headings
    const auto headings = static_cast<double>(middle.size());
    for (std::size_t i = 0; i < middle.size(); ++i) {
      // In axes along the line of sight: to the sensor, and across.
      const Eigen::Matrix2d to_box = rotation(2.0 * std::numbers::pi * static_cast<double>(i) / headings);
      const auto moments = extended_object::reflection_moments(table_[k].places, size.length_mean_m, size.width_mean_m,
                                                               to_box * Eigen::Vector2d(kAfar_m, 0.0));
      middle[i] = to_box.transpose() * moments.mean_m;
      any.depth_m += middle[i].x() / headings;
      any.scatter_m2 += 0.5 * moments.scatter_m2.trace() / headings;
    }
    for (const Eigen::Vector2d& m : middle) {
      any.along_m2 += (m.x() - any.depth_m) * (m.x() - any.depth_m) / headings;
      any.across_m2 += m.y() * m.y() / headings;
    }
  }
}

BoxMemory BoxEstimator::begin() const {
  BoxMemory m;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    m.classes[k].length_m = table_[k].size.length_mean_m;
    m.classes[k].length_variance_m2 = table_[k].size.length_std_m * table_[k].size.length_std_m;
  }
  weigh_classes(m);
  return m;
}

BoxEstimator::Course BoxEstimator::on_road(const Course& course, double road_rad, double vehicle_probability) const {
  struct Way {
    double weight, rad, variance_rad2;
  };
  const double std2 = parameters_.parallel_std_rad * parameters_.parallel_std_rad;
  const double share = vehicle_probability * parameters_.parallel_share, sum = std2 + course.variance_rad2;
  const auto along = [&](double rad) {
    const double e = geometry::wrap_angle(course.rad - rad);
    return Way{share * std::exp(-0.5 * e * e / sum) / std::sqrt(2.0 * std::numbers::pi * sum), rad + std2 / sum * e,
               std2 * course.variance_rad2 / sum};
  };
  const std::array<Way, 3> ways = {
      along(road_rad), along(road_rad + std::numbers::pi),
      Way{(1.0 - 2.0 * share) / (2.0 * std::numbers::pi), course.rad, course.variance_rad2}};
  const Way& best =
      *std::max_element(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.weight < b.weight; });
  double weights = 0.0, mean = 0.0, squares = 0.0;
  for (const Way& w : ways) {
    const double off = geometry::wrap_angle(w.rad - best.rad);
    weights += w.weight;
    mean += w.weight * off;
    squares += w.weight * (w.variance_rad2 + off * off);
  }
  mean /= weights;
  return {geometry::wrap_angle(best.rad + mean), squares / weights - mean * mean};
}

void BoxEstimator::follow_course(BoxMemory& m, const Component<double>& o, double elapsed_s, double road_rad) const {
  const double speed_mps = std::sqrt(squared_norm(o.velocity_mps));
  const double time_s = std::max(0.0, elapsed_s);
  const double turn_radps = turn_rate_std_radps(parameters_.turn, speed_mps * speed_mps);
  m.heading_variance_rad2 += 2.0 * turn_radps * turn_radps * parameters_.turn.time_s * time_s;
  if (speed_mps <= 0.0) return;
  const Vector2<double> across{-o.velocity_mps.y / speed_mps, o.velocity_mps.x / speed_mps};
  const double slip = parameters_.side_slip_mps;
  const auto vehicle = static_cast<std::size_t>(extended_object::RoadUserClass::kTwoWheeler);
  double vehicle_probability = 0.0;
  for (std::size_t k = vehicle; k < kRoadUserClasses; ++k) vehicle_probability += m.probability[k];
  // What the road says of the heading counts once, for the first course.
  const Course course{std::atan2(o.velocity_mps.y, o.velocity_mps.x),
                      (quadratic(o.velocity_covariance, across) + slip * slip) / (speed_mps * speed_mps)};
  const auto [course_rad, variance] = knows_heading(m) ? course : on_road(course, road_rad, vehicle_probability);
  const double change_rad = geometry::wrap_angle(course_rad - m.heading_rad);
  // Successive courses share their errors: the surer one counts, they are not averaged. The later one knows more, where
  // they contradict each other.
  if (variance < m.heading_variance_rad2 ||
      change_rad * change_rad > parameters_.contradiction_chi2 * (variance + m.heading_variance_rad2)) {
    if (std::abs(change_rad) > parameters_.known_heading_rad) m.has_point = false;
    m.heading_rad = course_rad;
    m.heading_variance_rad2 = variance;
  }
  const Vector2<double> along{o.velocity_mps.x / speed_mps, o.velocity_mps.y / speed_mps};
  m.largest_speed_mps =
      std::max(m.largest_speed_mps,
               speed_mps - parameters_.sure_speed_sigma * std::sqrt(quadratic(o.velocity_covariance, along)));
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
    m.probability[k] = std::log(c.prior_share) + of_speed - over * over + m.classes[k].log_evidence +
                       log_counts(c.count, m.detections, m.classes[k].expected, m.classes[k].log_expected);
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

ClassViews BoxEstimator::view(const BoxMemory& m, const Vector2<double>& position_m, double speed_mps,
                              const Viewpoint& from) const {
  ClassViews views;
  if (!knows_heading(m)) return views;
  const Eigen::Matrix2d to_box = rotation(m.heading_rad).transpose();
  const Eigen::Vector2d sensor = to_box * (eigen(from.sensor_m) - eigen(position_m));
  const Eigen::Vector2d facing = to_box * Eigen::Vector2d(std::cos(from.facing_rad), std::sin(from.facing_rad));
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    // The tracked point is chosen for all classes at once.
    if (m.probability[k] < parameters_.least_probability && m.has_point) continue;
    const ClassBox& box = m.classes[k];
    const ObjectClassModel& model = table_[k];
    ClassView& v = views[k];
    v.probability = m.probability[k];
    const Eigen::Vector2d sensor_box = sensor + box.point_m;
    v.reflections = extended_object::reflection_moments(model.places, box.length_m, model.size.width_mean_m, sensor_box,
                                                        {facing, from.half_view_rad, from.view_edge_rad});
    const double range_m = std::max(kLeastRange_m, sensor_box.norm());
    v.to_sensor = sensor_box / range_m;
    v.expected_detections =
        v.reflections.share_in_view * extended_object::expected_detections(model.count, range_m, v.to_sensor);
    const auto rates =
        extended_object::range_rate_mixture(model.micro_doppler, -v.to_sensor, -v.to_sensor.x() * speed_mps, speed_mps);
    v.wide_share = rates[2].weight;
    v.range_rate_variance_m2ps2 =
        (rates[0].weight * rates[0].variance_m2ps2 + rates[1].weight * rates[1].variance_m2ps2) /
        (rates[0].weight + rates[1].weight);
    if (!m.has_point) continue;
    v.offset_m = v.reflections.mean_m - box.point_m;
    const double depth_std_m = model.places.lasting_std_m;
    const Eigen::Vector2d turned(-v.offset_m.y(), v.offset_m.x());
    v.offset_covariance_m2 = box.length_variance_m2 * squared(v.reflections.mean_by_length - box.point_by_length) +
                             depth_std_m * depth_std_m * squared(v.to_sensor - m.to_sensor) +
                             m.heading_variance_rad2 * squared(turned);
  }
  return views;
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
    spot.col(0) /= 3.0;
    spot.row(0) /= 3.0;
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

void BoxEstimator::update(BoxMemory& m, const Component<double>& o, const BoxObservation& scan,
                          const ClassViews& views) const {
  const bool had_point = m.has_point;
  follow_course(m, o, scan.elapsed_s, scan.road_rad);
  // The heading jumped: views and tracked points are in axes of the old one.
  const bool is_turned = had_point && !m.has_point;
  if (is_turned) {
    for (ClassBox& c : m.classes) c.point_m = c.point_by_length = c.tracked_by_length_m2 = Eigen::Vector2d::Zero();
  }
  const double keep = std::exp(-std::max(0.0, scan.elapsed_s) / parameters_.forget_s);
  m.detections *= keep;
  for (ClassBox& c : m.classes) {
    c.log_evidence *= keep;
    c.expected *= keep;
    c.log_expected *= keep;
  }
  const bool is_viewed =
      std::any_of(views.begin(), views.end(), [](const ClassView& v) { return v.probability > 0.0; });
  if (scan.detections > 0.0 && is_viewed && !is_turned) {
    if (!m.has_point) {
      for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
        m.classes[k].point_m = views[k].reflections.mean_m;
        m.classes[k].point_by_length = views[k].reflections.mean_by_length;
      }
      m.to_sensor = views.front().to_sensor;
      m.has_point = true;
    } else {
      const Eigen::Matrix2d to_local = rotation(m.heading_rad);
      std::array<double, kRoadUserClasses> log_p{}, counts{};
      double top = -1e300;
      for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
        if (views[k].probability <= 0.0) continue;
        counts[k] = views[k].expected_detections;
        log_p[k] = learn_class(m.classes[k], views[k], table_[k], scan, to_local, m.to_sensor);
        top = std::max(top, log_p[k]);
      }
      count(m, scan.detections, counts);
      // Classes that are not computed keep their distance.
      for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
        if (views[k].probability > 0.0) m.classes[k].log_evidence += parameters_.evidence_share * (log_p[k] - top);
      }
    }
  }
  if (scan.detections > 0.0 && !is_viewed && !m.has_point) learn_without_heading(m, scan);
  weigh_classes(m);
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

BoxEstimator::Place BoxEstimator::place(const BoxMemory& m, const Vector2<double>& from_point_m,
                                        const Symmetric2<double>& covariance_m2) const {
  const Eigen::Matrix2d to_box = rotation(m.heading_rad).transpose();
  const Eigen::Vector2d from_point = to_box * eigen(from_point_m), turned(-from_point.y(), from_point.x());
  return {from_point, to_box * eigen(covariance_m2) * to_box.transpose() + m.heading_variance_rad2 * squared(turned)};
}

double BoxEstimator::inside(const BoxMemory& m, std::size_t k, const Place& place,
                            const Eigen::Vector2d& margin_m) const {
  if (!m.has_point) return 0.0;
  const ClassBox& c = m.classes[k];
  const Eigen::Vector2d at = c.point_m + place.from_point_m;
  const Eigen::Vector2d half = 0.5 * Eigen::Vector2d(c.length_m, table_[k].size.width_mean_m) + margin_m;
  constexpr double outside_chi2 = kCertainDeviations * kCertainDeviations;
  const double beside_m = std::abs(at.y()) - half.y(), variance = place.covariance_m2(1, 1);
  if (beside_m > 0.0 && beside_m * beside_m > outside_chi2 * variance) return 0.0;
  // The farther an end from the tracked point, the more the length that is uncertain moves it.
  const auto variance_of = [&](double end) {
    const double by_length = 0.5 * end - c.point_by_length.x();
    return place.covariance_m2(0, 0) + by_length * by_length * c.length_variance_m2;
  };
  const double front_m = half.x() - at.x(), rear_m = half.x() + at.x();
  const double of_front = variance_of(1.0), of_rear = variance_of(-1.0);
  if ((front_m < 0.0 && front_m * front_m > outside_chi2 * of_front) ||
      (rear_m < 0.0 && rear_m * rear_m > outside_chi2 * of_rear)) {
    return 0.0;
  }
  const auto before = [](double distance_m, double variance_m2) {
    return 0.5 * std::erfc(-distance_m / std::sqrt(2.0 * variance_m2));
  };
  const double sigma = std::sqrt(2.0 * variance);
  const double across = 0.5 * (std::erf((half.y() - at.y()) / sigma) + std::erf((half.y() + at.y()) / sigma));
  return std::max(0.0, across * (before(front_m, of_front) + before(rear_m, of_rear) - 1.0));
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

Box BoxEstimator::box(const BoxMemory& m, const Component<double>& o, const Vector2<double>& sensor_m) const {
  Box out;
  out.heading_rad = m.heading_rad;
  // No less is known than that every heading is alike.
  out.heading_variance_rad2 = std::min(m.heading_variance_rad2, std::numbers::pi * std::numbers::pi / 3.0);
  const Eigen::Vector2d p = eigen(o.position_m);
  // From the tracked point to the centre, and its covariance.
  std::array<Eigen::Vector2d, kRoadUserClasses> way;
  std::array<Eigen::Matrix2d, kRoadUserClasses> covariance;
  const Eigen::Matrix2d to_local = rotation(m.heading_rad);
  const Eigen::Matrix2d from_sight = rotation(std::atan2(sensor_m.y - o.position_m.y, sensor_m.x - o.position_m.x));
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const ClassBox& c = m.classes[k];
    if (m.has_point) {
      const double depth_std_m = table_[k].places.lasting_std_m;
      way[k] = -(to_local * c.point_m);
      covariance[k] = to_local *
                      (c.length_variance_m2 * squared(c.point_by_length) +
                       depth_std_m * depth_std_m * Eigen::Matrix2d::Identity()) *
                      to_local.transpose();
      // A heading that is wrong turns the way.
      covariance[k] += out.heading_variance_rad2 * squared(Eigen::Vector2d(-way[k].y(), way[k].x()));
    } else {
      const AnyHeading& any = any_heading_[k];
      way[k] = -(from_sight * Eigen::Vector2d(any.depth_m, 0.0));
      covariance[k] = from_sight * Eigen::Vector2d(any.along_m2, any.across_m2).asDiagonal() * from_sight.transpose();
    }
    const double w = m.probability[k];
    out.centre_m += w * (p + way[k]);
    out.length_m += w * c.length_m;
    out.width_m += w * table_[k].size.width_mean_m;
    out.height_m += w * table_[k].size.height_m;
  }
  out.covariance_m2 = eigen(o.position_covariance);
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const double w = m.probability[k];
    const ClassBox& c = m.classes[k];
    const Eigen::Vector2d d = p + way[k] - out.centre_m;
    const double dl = c.length_m - out.length_m, dw = table_[k].size.width_mean_m - out.width_m;
    out.covariance_m2 += w * (squared(d) + covariance[k]);
    out.length_variance_m2 += w * (c.length_variance_m2 + dl * dl);
    out.width_variance_m2 += w * (table_[k].size.width_std_m * table_[k].size.width_std_m + dw * dw);
    out.centre_length_covariance_m2 += w * dl * d;
    // The centre moves with the length that is uncertain.
    if (m.has_point) out.centre_length_covariance_m2 -= w * c.length_variance_m2 * (to_local * c.point_by_length);
  }
  return out;
}

}  // namespace boresight::tracking
