#include "services/tracker/core/classes/class_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

constexpr std::array<std::string_view, kClassFeatures> kNames = {"count_rate",
                                                                 "detected_share",
                                                                 "most_count",
                                                                 "length_m",
                                                                 "width_m",
                                                                 "depth_m",
                                                                 "area_m2",
                                                                 "height_m",
                                                                 "volume_m3",
                                                                 "along_std_m",
                                                                 "across_std_m",
                                                                 "reach_along_m",
                                                                 "reach_across_m",
                                                                 "strength_db",
                                                                 "strongest_db",
                                                                 "strength_std_db",
                                                                 "snr_db",
                                                                 "range_rate_std_mps",
                                                                 "range_rate_residual_mps",
                                                                 "wide_share",
                                                                 "speed_mps",
                                                                 "largest_speed_mps",
                                                                 "speed_std_mps",
                                                                 "turn_rate_radps",
                                                                 "range_m",
                                                                 "nearest_m",
                                                                 "aspect",
                                                                 "duration_s"};
static_assert(!kNames.back().empty());

[[nodiscard]] double ratio(double of, double to) {
  return to > 0.0 ? of / to : ClusterPoint::kUnknown;
}

}  // namespace

std::string_view name_of(ClassFeature feature) {
  return kNames[static_cast<std::size_t>(feature)];
}

void ClassEvidence::Sums::fade(double keep) {
  weight *= keep;
  sum *= keep;
  squares *= keep;
}

void ClassEvidence::Sums::add(double value, double by) {
  if (!std::isfinite(value) || !(by > 0.0)) return;
  weight += by;
  sum += by * value;
  squares += by * value * value;
}

double ClassEvidence::Sums::mean() const {
  return ratio(sum, weight);
}

double ClassEvidence::Sums::std() const {
  if (weight <= 0.0) return ClusterPoint::kUnknown;
  return std::sqrt(std::max(0.0, squares / weight - mean() * mean()));
}

void ClassEvidence::Scatter::fade(double keep) {
  squares *= keep;
  freedom *= keep;
}

void ClassEvidence::Scatter::add(const ClusterStatistics& of_scan, double deviation) {
  if (!(of_scan.number > 1.0) || !std::isfinite(deviation)) return;
  squares += of_scan.number * deviation * deviation;
  freedom += of_scan.number - 1.0;
}

double ClassEvidence::Scatter::std() const {
  return std::sqrt(ratio(squares, freedom));
}

void ClassEvidence::Most::add(double now, double keep) {
  if (!std::isfinite(now)) return;
  value = std::isfinite(value) ? std::max(now, now + keep * (value - now)) : now;
}

void ClassEvidence::fade(double keep) {
  for (double* const sum : {&scans_, &detected_, &detections_, &expected_}) *sum *= keep;
  for (Sums* const sums : {&speed_, &range_, &aspect_, &strength_, &strongest_, &snr_, &residual_, &wide_, &turn_}) {
    sums->fade(keep);
  }
  for (Scatter* const scatter : {&along_, &across_, &range_rate_}) scatter->fade(keep);
}

void ClassEvidence::add(const TrackObservation& scan, const ClassEvidenceParameters& parameters) {
  const double elapsed_s = std::max(0.0, scan.elapsed_s);
  const double keep = std::exp(-elapsed_s / parameters.memory_s);
  duration_s_ += elapsed_s;
  fade(keep);
  add_motion(scan, parameters);
  if (scan.points.empty() && scan.in_view < parameters.least_in_view) return;
  const Vector2<double> from_sensor = scan.position_m - scan.sensor_m;
  const double range_m = std::sqrt(squared_norm(from_sensor));
  const double expected =
      std::pow(std::max(range_m, parameters.near_range_m) / parameters.count_range_m, -parameters.count_power);
  scans_ += 1.0;
  expected_ += expected;
  if (scan.points.empty()) return;
  range_.add(range_m);
  nearest_m_ = std::fmin(nearest_m_, range_m);
  if (range_m > 0.0) {
    const double along =
        (from_sensor.x * std::cos(scan.heading_rad) + from_sensor.y * std::sin(scan.heading_rad)) / range_m;
    aspect_.add(std::abs(along));
  }
  add_points(scan, parameters, expected, keep);
}

void ClassEvidence::add_motion(const TrackObservation& scan, const ClassEvidenceParameters& parameters) {
  const double speed_mps = std::sqrt(squared_norm(scan.velocity_mps));
  speed_.add(speed_mps);
  // What the track surely exceeds: a new track is fast by chance.
  const double variance = std::max(scan.velocity_covariance_m2ps2.xx, scan.velocity_covariance_m2ps2.yy);
  const double sure_mps = std::max(0.0, speed_mps - std::sqrt(std::max(0.0, variance)));
  largest_speed_.add(sure_mps, 1.0);
  const double course_rad = std::atan2(scan.velocity_mps.y, scan.velocity_mps.x) + scan.yaw_rad;
  if (course_time_s_ < 0.0) {
    course_rad_ = course_rad;
    course_time_s_ = duration_s_;
  } else if (duration_s_ - course_time_s_ >= parameters.course_s) {
    turn_.add(std::abs(geometry::wrap_angle(course_rad - course_rad_)) / (duration_s_ - course_time_s_));
    course_rad_ = course_rad;
    course_time_s_ = duration_s_;
  }
}

void ClassEvidence::add_points(const TrackObservation& scan, const ClassEvidenceParameters& parameters, double expected,
                               double keep) {
  const ClusterFeatures cluster = cluster_features(scan.points, scan.heading_rad);
  if (cluster.points <= 0.0) return;
  detected_ += 1.0;
  detections_ += cluster.points;
  most_count_.add(cluster.points / expected, keep);
  length_.add(cluster.length_m, keep);
  width_.add(cluster.width_m, keep);
  depth_.add(cluster.depth_m, keep);
  area_.add(cluster.area_m2, keep);
  height_.add(cluster.elevation_m.largest, keep);
  volume_.add(cluster.volume_m3, keep);
  const ClusterStatistics counted{cluster.points};
  along_.add(counted, cluster.along_std_m);
  across_.add(counted, cluster.across_std_m);
  range_rate_.add(cluster.range_rate_mps, cluster.range_rate_mps.std);
  strongest_.add(cluster.strength_db.largest);
  const double c = std::cos(scan.heading_rad), s = std::sin(scan.heading_rad);
  double ahead = NAN, behind = NAN, left = NAN, right = NAN;
  for (const ClusterPoint& point : scan.points) {
    if (!(point.weight > 0.0) || !std::isfinite(point.weight + point.position_m.x + point.position_m.y)) continue;
    const Vector2<double> d = point.position_m - scan.position_m;
    const double along_m = c * d.x + s * d.y, across_m = -s * d.x + c * d.y;
    ahead = std::fmax(ahead, along_m);
    behind = std::fmax(behind, -along_m);
    left = std::fmax(left, across_m);
    right = std::fmax(right, -across_m);
    strength_.add(point.strength_db, point.weight);
    snr_.add(point.snr_db, point.weight);
    const double residual_mps = point.range_rate_mps - dot(point.sight, scan.velocity_mps);
    residual_.add(residual_mps, point.weight);
    if (!std::isfinite(residual_mps)) continue;
    wide_.add(std::abs(residual_mps) > parameters.wide_range_rate_mps ? 1.0 : 0.0, point.weight);
  }
  ahead_.add(ahead, keep);
  behind_.add(behind, keep);
  left_.add(left, keep);
  right_.add(right, keep);
}

ClassFeatures ClassEvidence::features() const {
  ClassFeatures f{};
  const auto set = [&f](ClassFeature feature, double value) { f[static_cast<std::size_t>(feature)] = value; };
  set(ClassFeature::kCountRate, ratio(detections_, expected_));
  set(ClassFeature::kDetectedShare, ratio(detected_, scans_));
  set(ClassFeature::kMostCount, most_count_.value);
  set(ClassFeature::kLength, length_.value);
  set(ClassFeature::kWidth, width_.value);
  set(ClassFeature::kDepth, depth_.value);
  set(ClassFeature::kArea, area_.value);
  set(ClassFeature::kHeight, height_.value);
  set(ClassFeature::kVolume, volume_.value);
  set(ClassFeature::kAlongStd, along_.std());
  set(ClassFeature::kAcrossStd, across_.std());
  set(ClassFeature::kReachAlong, ahead_.value + behind_.value);
  set(ClassFeature::kReachAcross, left_.value + right_.value);
  set(ClassFeature::kStrength, strength_.mean());
  set(ClassFeature::kStrongest, strongest_.mean());
  set(ClassFeature::kStrengthStd, strength_.std());
  set(ClassFeature::kSnr, snr_.mean());
  set(ClassFeature::kRangeRateStd, range_rate_.std());
  set(ClassFeature::kRangeRateResidual, std::sqrt(ratio(residual_.squares, residual_.weight)));
  set(ClassFeature::kWideShare, wide_.mean());
  set(ClassFeature::kSpeed, speed_.mean());
  set(ClassFeature::kLargestSpeed, largest_speed_.value);
  set(ClassFeature::kSpeedStd, speed_.std());
  set(ClassFeature::kTurnRate, turn_.mean());
  set(ClassFeature::kRange, range_.mean());
  set(ClassFeature::kNearest, nearest_m_);
  set(ClassFeature::kAspect, aspect_.mean());
  set(ClassFeature::kDuration, duration_s_);
  return f;
}

}  // namespace boresight::tracking
