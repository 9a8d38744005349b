#include "services/tracker/core/model/box_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <Eigen/LU>

#include "services/common/extended_object/detection_count.hpp"
#include "services/common/extended_object/range_rate_model.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/model/plane_axes.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

using extended_object::kRoadUserClasses;
using extended_object::ObjectClassModel;

BoxEstimator::BoxEstimator(const extended_object::ObjectClassTable& table, const BoxParameters& parameters)
    : table_(table), parameters_(parameters) {
  constexpr double kAfar_m = 1e3;
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const double shape = table_[k].count.dispersion_shape;
    prior_[k] = {std::log(table_[k].prior_share), std::lgamma(shape), shape * std::log(shape)};
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
    begun_.classes[k].length_m = size.length_mean_m;
    begun_.classes[k].length_variance_m2 = size.length_std_m * size.length_std_m;
  }
  weigh_classes(begun_);
}

Course BoxEstimator::course(const Component<double>& o) const {
  const double squared_speed = squared_norm(o.velocity_mps), slip = parameters_.side_slip_mps;
  const Vector2<double> across{-o.velocity_mps.y, o.velocity_mps.x};
  return {std::atan2(o.velocity_mps.y, o.velocity_mps.x),
          (quadratic(o.velocity_covariance, across) / squared_speed + slip * slip) / squared_speed};
}

double BoxEstimator::vehicle_probability(const BoxMemory& m) {
  const auto first = static_cast<std::size_t>(extended_object::RoadUserClass::kTwoWheeler);
  return std::accumulate(m.probability.begin() + first, m.probability.end(), 0.0);
}

void BoxEstimator::follow_course(BoxMemory& m, const Component<double>& o, double elapsed_s, const Road& road) const {
  const double speed_mps = std::sqrt(squared_norm(o.velocity_mps));
  const double time_s = std::max(0.0, elapsed_s);
  const double turn_radps = turn_rate_std_radps(parameters_.turn, speed_mps * speed_mps);
  m.heading_variance_rad2 += 2.0 * turn_radps * turn_radps * parameters_.turn.time_s * time_s;
  if (speed_mps <= 0.0) return;
  // What the road says of the heading counts once, for the first course.
  const Course seen = course(o);
  const auto [course_rad, variance] =
      knows_heading(m) ? seen : on_road(parameters_.road, road, seen, vehicle_probability(m));
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

void BoxEstimator::update(BoxMemory& m, const Component<double>& o, const BoxObservation& scan,
                          const ClassViews& views) const {
  const bool had_point = m.has_point;
  follow_course(m, o, scan.elapsed_s, scan.road);
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

void BoxEstimator::observe_heading(BoxMemory& m, const Heading& z) const {
  if (!knows_heading(m)) return;
  const double gain = m.heading_variance_rad2 / (m.heading_variance_rad2 + z.variance_rad2);
  m.heading_rad = geometry::wrap_angle(m.heading_rad + gain * geometry::wrap_angle(z.rad - m.heading_rad));
  m.heading_variance_rad2 *= 1.0 - gain;
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
