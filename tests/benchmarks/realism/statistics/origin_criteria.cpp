#include "tests/benchmarks/realism/statistics/origin_criteria.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

namespace {

// Limits of the origins. R: measured on RadarScenes. choice: R states the origin, but not this limit.
constexpr double kSineTolerance = 0.06;  // 1; R: twice the sd 0.03 of the step of sin(azimuth)
constexpr double kSameRange_m = 0.5;     // m; choice: narrow, so that few pairs are by chance
constexpr double kSameRate_mps = 0.3;    // m/s; choice: above the 95 % quantile of the noise in R, 0.21 m/s
constexpr double kBesideObject_rad = 4.0 * M_PI / 180.0;  // rad; R: another azimuth, by over 4°
constexpr double kObjectRange_m = 1.0;                    // m; choice: narrow, so that few pairs are by chance
constexpr double kObjectRate_mps = 0.5;                   // m/s; choice: smallest deviation that R counts
// Of the pairs of ghosts and objects, for an object whose detections are not asked.
constexpr double kTrackRange_m = 3.0, kTrackRate_mps = 0.6;  // m, m/s; R
constexpr double kBehind_rad = 3.0 * M_PI / 180.0;           // rad; R: upper end of 2.5–3°
constexpr double kRest_m = 1.5;        // m; choice: R has 0.3 % of a car's detections further across its track
constexpr double kRestRate_mps = 1.0;  // m/s; choice: smallest deviation of a false mover

/// Whether a moving object in view fulfils `holds(object, angle)`, the angle that from its centre to the detection.
template <typename Holds>
bool any_mover(const ObservedScan& scan, const ObservedDetection& d, const Holds& holds) {
  const Eigen::Vector2d sight = scan.sight_to(d.position_m);
  return std::any_of(scan.objects.begin(), scan.objects.end(), [&](const ObservedObject& object) {
    if (object.user == RoadUser::kStandingCar || object.user == RoadUser::kStandingTruck) return false;
    const Eigen::Vector2d centre = scan.sight_to(object.position_m);
    return holds(object, std::atan2(centre.x() * sight.y() - centre.y() * sight.x(), centre.dot(sight)));
  });
}

}  // namespace

bool is_ambiguous_width(double deviation_mps) {
  return std::abs(deviation_mps) >= kAmbiguityFrom_mps && std::abs(deviation_mps) <= kAmbiguityTo_mps;
}

bool is_doppler_ambiguity(const ObservedDetection& d) {
  const double expected_mps = d.range_rate_mps - d.deviation_mps;
  return is_ambiguous_width(d.deviation_mps) && d.range_rate_mps * expected_mps < 0.0;
}

bool is_at_range_and_rate(const ObservedDetection& stationary, const ObservedDetection& mover) {
  return stationary.is_stationary() && std::abs(stationary.range_m - mover.range_m) <= kSameRange_m &&
         std::abs(stationary.range_rate_mps - mover.range_rate_mps) <= kSameRate_mps;
}

bool is_ambiguous_azimuth(const ObservedScan& scan, const ObservedDetection& mover, double step) {
  return std::any_of(scan.detections.begin(), scan.detections.end(), [&](const ObservedDetection& d) {
    return is_at_range_and_rate(d, mover) &&
           std::abs(std::abs(std::sin(d.azimuth_rad) - std::sin(mover.azimuth_rad)) - step) <= kSineTolerance;
  });
}

bool is_beside_object(const ObservedScan& scan, const ObservedDetection& mover) {
  return std::any_of(scan.detections.begin(), scan.detections.end(), [&](const ObservedDetection& d) {
    return d.is_of_mover() && std::abs(d.range_m - mover.range_m) <= kObjectRange_m &&
           std::abs(d.range_rate_mps - mover.range_rate_mps) <= kObjectRate_mps &&
           std::abs(d.azimuth_rad - mover.azimuth_rad) > kBesideObject_rad;
  });
}

bool is_beside_tracked_object(const ObservedScan& scan, const ObservedDetection& mover) {
  return any_mover(scan, mover, [&](const ObservedObject& object, double angle_rad) {
    return std::abs(mover.range_m - object.range_m) <= kTrackRange_m &&
           std::abs(mover.range_rate_mps - scan.range_rate_mps(object)) <= kTrackRate_mps &&
           std::abs(angle_rad) > kBesideObject_rad;
  });
}

bool is_behind_object(const ObservedScan& scan, const ObservedDetection& mover, double turn_rad) {
  return any_mover(scan, mover, [&](const ObservedObject& object, double angle_rad) {
    return mover.range_m > object.range_m + object.length_m && std::abs(angle_rad - turn_rad) <= kBehind_rad &&
           std::abs(mover.range_rate_mps - scan.range_rate_mps(object)) <= kTrackRate_mps;
  });
}

bool is_at_twice_the_range(const ObservedScan& scan, const ObservedDetection& mover) {
  return any_mover(scan, mover, [&](const ObservedObject& object, double angle_rad) {
    return std::abs(mover.range_m - 2.0 * object.range_m) <= kTrackRange_m && std::abs(angle_rad) <= kBehind_rad &&
           std::abs(mover.range_rate_mps - 2.0 * scan.range_rate_mps(object)) <= kTrackRate_mps;
  });
}

bool is_rest_of_object(const ObservedScan& scan, const ObservedDetection& mover) {
  return std::any_of(scan.detections.begin(), scan.detections.end(), [&](const ObservedDetection& d) {
    return d.is_of_mover() && (d.position_m - mover.position_m).norm() <= kRest_m &&
           std::abs(d.range_rate_mps - mover.range_rate_mps) <= kRestRate_mps;
  });
}

}  // namespace boresight::bench::realism
