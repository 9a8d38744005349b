// Size and heading of a track, from the detections over time, and what of it a sensor sees.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "interfaces/messages/track_list.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/tracker/core/clusters.hpp"

namespace boresight::tracking {

/// Which of a box's faces look towards a sensor; signs along the box's axes, 0 for neither.
struct VisibleFaces {
  double end;   ///< +1 the front, −1 the rear
  double side;  ///< +1 the left side, −1 the right one
};

/// Box along the heading. A side that is seen grows quickly to what is seen and shrinks slowly, as one scan sees only
/// some of its reflections; a side that is not seen stays as it is, at the start that of a car.
struct Extent {
  static constexpr double kCarLength_m = 4.5, kCarWidth_m = 1.8;
  double heading_rad = 0.0;
  double length_m = kCarLength_m;
  double width_m = kCarWidth_m;
  double height_m = 0.0;
  double strongest_dbsm = std::numeric_limits<double>::quiet_NaN();  ///< mean of the scans' strongest detections

  /// A person's or a cycle's. A vehicle's corners and plates reflect far more than people and cycles do (some 10 dBsm
  /// beside some -5), so that strength tells sizes apart long before the detections do. Without RCS all are vehicles.
  bool is_small = false;
  bool was_small = false;  ///< when it was first heard

  /// From vehicle axes to the box's, along and across it, and back.
  [[nodiscard]] Eigen::Vector2d to_body(const Eigen::Vector2d& v) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    return {c * v.x() + s * v.y(), -s * v.x() + c * v.y()};
  }
  [[nodiscard]] Eigen::Vector2d from_body(const Eigen::Vector2d& v) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
  }

  [[nodiscard]] VisibleFaces visible_faces(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& sensor_m) const {
    const Eigen::Vector2d at = to_body(sensor_m - centre_m);
    const auto face = [](double coordinate, double half) {
      return std::abs(coordinate) > half ? std::copysign(1.0, coordinate) : 0.0;
    };
    return {face(at.x(), 0.5 * length_m), face(at.y(), 0.5 * width_m)};
  }

  /// The course, or what is known of the heading, turns the box.
  void follow_heading(double wanted_rad) {
    // The velocity across the line of sight is noisy, and where the centre is taken to be depends on the box's heading:
    // that follows over some ten updates, or one would excite the other.
    constexpr double kGain = 0.1;
    heading_rad = geometry::wrap_angle(heading_rad + kGain * geometry::wrap_angle(wanted_rad - heading_rad));
  }

  /// What is seen of a side farther than `sure_m` beyond an end of the box is of it: the box grows there, and its
  /// centre moves by what is returned.
  [[nodiscard]] Eigen::Vector2d grow_to(const Cluster& cluster, const Eigen::Vector2d& centre_m,
                                        const Eigen::Vector2d& sensor_m, double sure_m) {
    // Of a car that shows its side at more of a slant, what lies beyond its end may be a ghost behind it; and cars
    // differ by less than that, so what lies farther off is the next one. Nor does a car that swallows what follows it
    // become a truck.
    constexpr double kShown = 0.1, kNext_m = 1.5;
    const bool is_truck = length_m > kTruck_m;
    const bool shows_length = is_truck || side_shown(to_body(sensor_m - centre_m)) >= kShown;
    if (!shows_length || visible_faces(centre_m, sensor_m).side == 0.0) return {0.0, 0.0};
    const double end_m = 0.5 * length_m + sure_m;
    double ahead_m = 0.0, behind_m = 0.0;
    for (std::uint32_t i = 0; i < cluster.number_on_outline; ++i) {
      const double at = to_body(cluster.outline[i] - centre_m).x();
      if (!is_truck && std::abs(at) > 0.5 * length_m + kNext_m) continue;
      ahead_m = std::max(ahead_m, at - end_m);
      behind_m = std::max(behind_m, -at - end_m);
    }
    constexpr double kGain = 0.3;
    const double longest_m = is_truck ? kLongest_m : kTruck_m;
    const double more_m = kGain * std::min(std::max(ahead_m, behind_m), longest_m - length_m);
    length_m += more_m;
    return from_body({ahead_m > behind_m ? 0.5 * more_m : -0.5 * more_m, 0.0});
  }

  /// What is seen now sets the size; `velocity` over ground tells what it may be. It grows to where what is seen lies
  /// beyond it, faces that are seen stay where they are else, and the centre moves by what is returned.
  [[nodiscard]] Eigen::Vector2d update(const Cluster& cluster, const Eigen::Vector2d& centre_m,
                                       const Eigen::Vector2d& velocity_mps, const Eigen::Vector2d& sensor_m,
                                       bool has_elevation) {
    const std::size_t n = std::min<std::size_t>(cluster.number_on_outline, cluster.outline.size());
    if (n == 0) return {0.0, 0.0};
    hear(cluster.strongest_dbsm, velocity_mps.norm());
    const Eigen::Vector2d before_m(length_m, width_m);
    Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d p = to_body(cluster.outline[i]);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    if (!is_small) without_noise(cluster, low, high);
    const VisibleFaces faces = visible_faces(centre_m, sensor_m);
    // Few detections say little of how long a side is, and a face that is seen at a slant shows little of itself.
    const double said = static_cast<double>(n) / static_cast<double>(n + 3);
    const Eigen::Vector2d sight = to_body(centre_m - sensor_m).normalized();
    // A vehicle's side is not both weak and short: who was taken for one, as something strong was near, walks or
    // cycles.
    const double shrinks = !is_small && is_surely_small(velocity_mps.norm()) ? kQuick : kSlow;
    follow(length_m, high.x() - low.x(), faces.side == 0.0 ? 0.0 : said * side_shown(to_body(sensor_m - centre_m)),
           kSmallest_m, is_small ? kCycleLength_m : kLongest_m, shrinks);
    const double narrowest_m = !is_small && length_m > kTwoWheeler_m ? std::min(width_m, kNarrowestCar_m) : kSmallest_m;
    follow(width_m, high.y() - low.y(), faces.end == 0.0 ? 0.0 : said * sight.x() * sight.x(), narrowest_m,
           is_small ? kCycleWidth_m : kWidest_m, kSlow);
    if (has_elevation) follow(height_m, cluster.z_max_m, 1.0, 0.0, 5.0, kSlow);
    if (is_small) return {0.0, 0.0};
    const Eigen::Vector2d centre = to_body(centre_m);
    return from_body({shift(before_m.x(), length_m, low.x() - centre.x(), high.x() - centre.x(), faces.end),
                      shift(before_m.y(), width_m, low.y() - centre.y(), high.y() - centre.y(), faces.side)});
  }

  /// Whether a person or a cycle would be as strong and as fast.
  [[nodiscard]] bool may_be_small(double speed_mps) const {
    return strongest_dbsm < kLeastOfVehicle_dbsm && strongest_dbsm > kLeastOfPerson_dbsm &&
           speed_mps < kFastestCycle_mps;
  }

  /// Whether hardly anything that is so fast reflects as little. Mirrors take away power, so images do. What was never
  /// heard is not.
  [[nodiscard]] bool is_too_weak(double speed_mps) const {
    if (speed_mps > kFastestCycle_mps) return strongest_dbsm < kWeakestVehicle_dbsm;
    return strongest_dbsm < (outruns_people(speed_mps) ? kWeakestCycle_dbsm : kWeakestPerson_dbsm);
  }
  [[nodiscard]] static bool outruns_people(double speed_mps) { return speed_mps > kFastestRunner_mps; }

  /// Whether a person or a cycle would be as strong and as fast, and neither a vehicle nor an image would.
  [[nodiscard]] bool is_surely_small(double speed_mps) const {
    return may_be_small(speed_mps) && strongest_dbsm < kWeakestVehicle_dbsm && !is_too_weak(speed_mps);
  }

  /// As strong as `dbsm` and at that speed: as long as a person or a cycle would be so, the box is no larger than what
  /// was seen of it.
  void hear(double dbsm, double speed_mps) {
    constexpr double kGain = 0.2, kSurely_db = 3.0;
    if (!std::isfinite(dbsm)) return;
    const bool is_first = !std::isfinite(strongest_dbsm);
    strongest_dbsm = is_first ? dbsm : strongest_dbsm + kGain * (dbsm - strongest_dbsm);
    const bool small = may_be_small(speed_mps);
    was_small = was_small || (is_first && small);
    // Who was taken for a vehicle because a vehicle passed is small again when that is gone. So is who always was taken
    // for one, once their side has been seen to be short.
    const bool is_short = length_m < kCycleLength_m && is_surely_small(speed_mps);
    const bool is_weak = was_small && small && strongest_dbsm < kLeastOfVehicle_dbsm - kSurely_db;
    const bool is_again = !is_small && (is_weak || is_short);
    if ((is_first && small) || is_again) {
      is_small = true;
      length_m = kSmallLength_m;
      width_m = kSmallWidth_m;
    } else if (is_small && !small) {
      is_small = false;
      length_m = std::max(length_m, kCarLength_m);
      width_m = std::max(width_m, kCarWidth_m);
    }
  }

  [[nodiscard]] ObjectClass object_class() const {
    if (length_m > kTruck_m) return ObjectClass::kTruck;
    if (length_m > 2.6) return ObjectClass::kCar;
    return length_m > 1.4 ? ObjectClass::kTwoWheeler : ObjectClass::kUnknown;
  }

  /// Whether the other box lies before or behind this one, at most `gap_m` away, with its middle at most `besides_m`
  /// off this one's middle line.
  [[nodiscard]] bool in_file(const Eigen::Vector2d& centre_m, const Extent& other,
                             const Eigen::Vector2d& other_centre_m, double gap_m, double besides_m) const {
    const Eigen::Vector2d at = to_body(other_centre_m - centre_m).cwiseAbs();
    return at.x() < 0.5 * (length_m + other.length_m) + gap_m && at.y() < besides_m;
  }
  /// The same in this one's track, as far as it is wide.
  [[nodiscard]] bool in_file(const Eigen::Vector2d& centre_m, const Extent& other,
                             const Eigen::Vector2d& other_centre_m, double gap_m) const {
    // What the narrower one is seen to be wide depends on the side that is seen; lanes are over two of these apart.
    constexpr double kBesides_m = 1.5;
    return in_file(centre_m, other, other_centre_m, gap_m,
                   std::min(0.5 * std::max(width_m, other.width_m), kBesides_m));
  }

  /// Makes the box reach as far along as a place that is of it, but grow by no more than `most_m`; returns where its
  /// centre is then.
  [[nodiscard]] Eigen::Vector2d lengthen(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& to_m,
                                         double most_m = kLongest_m) {
    const double at = to_body(to_m - centre_m).x(), half = 0.5 * length_m;
    const double low = -half - std::clamp(-half - at, 0.0, most_m), high = half + std::clamp(at - half, 0.0, most_m);
    length_m = std::min(high - low, kLongest_m);
    return centre_m + 0.5 * (low + high) * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  }

  /// Whether the sensor stands well beside the box's track and sees how long the box is. Else what lies behind its near
  /// end in the line of sight is a type-1 ghost of that as likely as its other end.
  [[nodiscard]] bool shows_side(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& sensor_m) const {
    constexpr double kBesides_m = 1.0;
    return std::abs(to_body(sensor_m - centre_m).y()) > 0.5 * width_m + kBesides_m;
  }

  /// The shortest way along the box's axes by which it comes off a rectangle of the vehicle's axes, which it overlaps;
  /// else nothing.
  [[nodiscard]] Eigen::Vector2d way_off(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& middle_m,
                                        const Eigen::Vector2d& half_m) const {
    const Eigen::Vector2d at = to_body(centre_m - middle_m);
    const double c = std::abs(std::cos(heading_rad)), s = std::abs(std::sin(heading_rad));
    const Eigen::Vector2d reach(0.5 * length_m + c * half_m.x() + s * half_m.y(),
                                0.5 * width_m + s * half_m.x() + c * half_m.y());
    const Eigen::Vector2d depth = reach - at.cwiseAbs();
    if (depth.minCoeff() <= 0.0) return {0.0, 0.0};
    const int axis = depth.x() < depth.y() ? 0 : 1;
    Eigen::Vector2d shift(0.0, 0.0);
    shift(axis) = std::copysign(depth(axis), at(axis));
    return from_body(shift);
  }

  /// Whether a point lies in the box, made larger by a margin on every side.
  [[nodiscard]] bool contains(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& point_m, double margin_m) const {
    return contains(centre_m, point_m, margin_m, margin_m);
  }
  /// The same with margins ahead and behind, and beside it.
  [[nodiscard]] bool contains(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& point_m, double along_m,
                              double beside_m) const {
    const Eigen::Vector2d at = to_body(point_m - centre_m);
    return std::abs(at.x()) < 0.5 * length_m + along_m && std::abs(at.y()) < 0.5 * width_m + beside_m;
  }

  /// Whether the box is in the way from one place to another that is not in it.
  [[nodiscard]] bool hides(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& from_m,
                           const Eigen::Vector2d& to_m) const {
    const Eigen::Vector2d from = to_body(from_m - centre_m), way = to_body(to_m - from_m);
    const Eigen::Vector2d half(0.5 * length_m, 0.5 * width_m);
    double enters = 0.0, leaves = 1.0;
    for (const int axis : {0, 1}) {
      constexpr double kParallel_m = 1e-9;
      if (std::abs(way(axis)) < kParallel_m) {
        if (std::abs(from(axis)) > half(axis)) return false;
        continue;
      }
      const double a = (-half(axis) - from(axis)) / way(axis), b = (half(axis) - from(axis)) / way(axis);
      enters = std::max(enters, std::min(a, b));
      leaves = std::min(leaves, std::max(a, b));
    }
    return enters < leaves && enters > 0.0 && leaves < 1.0;
  }

 private:
  static constexpr double kLongest_m = 20.0, kSmallest_m = 0.5;
  // What more is seen across is noise, a neighbour or a ghost: 2.6 m is the most that is allowed on roads (96/53/EC).
  // And what is longer than a two-wheeler is not as narrow as the part of it that is seen.
  static constexpr double kWidest_m = 2.6, kTwoWheeler_m = 3.0, kNarrowestCar_m = 1.6;
  static constexpr double kTruck_m = 6.5;
  static constexpr double kCycleLength_m = 2.0, kCycleWidth_m = 1.0;
  static constexpr double kSmallLength_m = 1.2, kSmallWidth_m = 0.7;  // between a person and a cycle
  static constexpr double kLeastOfVehicle_dbsm = 3.0;
  static constexpr double kFastestCycle_mps = 9.0;
  static constexpr double kFastestRunner_mps = 5.0;
  // A vehicle's strongest reflection, from wherever it is seen, that of a cycle with who rides it, and a grown
  // person's, who reflects some -8 dBsm.
  static constexpr double kWeakestVehicle_dbsm = -5.0, kWeakestCycle_dbsm = -9.0, kWeakestPerson_dbsm = -11.0;
  static constexpr double kLeastOfPerson_dbsm = -16.0;  // what is weaker is a ghost of something larger
  /// Across the line of sight noise spreads the detections of a vehicle far ahead over more than its width: so much
  /// less lies between the outermost ones.
  void without_noise(const Cluster& cluster, Eigen::Vector2d& low, Eigen::Vector2d& high) const {
    constexpr double kOutermost = 1.0;  // standard deviations: where the outermost of four lie
    const Eigen::Vector2d across = from_body({0.0, 1.0});
    const double std_m = std::sqrt(cluster.weight * across.dot(cluster.covariance_m2 * across));
    const double middle = 0.5 * (low.y() + high.y());
    const double half = std::max(0.0, 0.5 * (high.y() - low.y()) - kOutermost * std_m);
    low.y() = middle - half;
    high.y() = middle + half;
  }
  /// How much of a side is to be seen up to its far end, 0 … 1: from nearby that is at a slant even for a sensor beside
  /// the middle, where nothing has a range rate over ground. Of a truck alongside each radar sees but a piece.
  [[nodiscard]] double side_shown(const Eigen::Vector2d& sensor_in_body_m) const {
    const double along_m = std::abs(sensor_in_body_m.x()) + 0.5 * length_m, beside_m = sensor_in_body_m.y();
    return beside_m * beside_m / (beside_m * beside_m + along_m * along_m);
  }
  /// Of the centre along an axis, as the size there changes; what is seen lies from `low` to `high`, and `face` is
  /// seen.
  static double shift(double before, double after, double low, double high, double face) {
    const double more = 0.5 * (after - before);
    const double above = std::max(0.0, high - 0.5 * before), below = std::max(0.0, -0.5 * before - low);
    return more > 0.0 && above + below > 0.0 ? more * (above - below) / (above + below) : -face * more;
  }
  // Shares of the difference that one scan makes up for.
  static constexpr double kSlow = 0.02, kQuick = 0.3;
  /// `shown`: how much of it was to be seen, 0 … 1; `shrinks`: by what share, if it shows less.
  static void follow(double& value, double seen, double shown, double low, double high, double shrinks) {
    const double gain = seen > value ? kQuick : shrinks * shown;
    value = std::clamp(value + gain * (seen - value), low, high);
  }
};

}  // namespace boresight::tracking
