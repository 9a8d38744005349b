// One scan with its truth, in the form that the statistics read. All places are in a plane: x and y of the world.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/simulator/detection_truth.hpp"

namespace boresight::bench::realism {

/// Road users as the measured tables part them. Vans count as cars.
enum class RoadUser : std::uint8_t { kCar, kTruck, kTwoWheeler, kPedestrian, kStandingCar, kStandingTruck };
inline constexpr std::size_t kRoadUsers = 6;

[[nodiscard]] constexpr bool is_moving_vehicle(RoadUser user) {
  return user == RoadUser::kCar || user == RoadUser::kTruck;
}

enum class Facing : std::uint8_t { kForward, kSideways, kRear };

/// Sectors of the aspect, the angle between heading and line of sight: 0 from behind, π from ahead.
inline constexpr double kEndSector_rad = M_PI / 6.0;
inline constexpr double kSideFrom_rad = M_PI / 3.0, kSideTo_rad = 2.0 * M_PI / 3.0;

/// A moving detection by the measured definition: it deviates by more than this from a stationary reflector.
inline constexpr double kMoving_mps = 1.0;
/// Widths of a range rate that was resolved wrongly.
inline constexpr double kAmbiguityFrom_mps = 21.5, kAmbiguityTo_mps = 34.0;

struct ObservedObject {
  std::uint32_t id = 0;
  RoadUser user = RoadUser::kCar;
  Eigen::Vector2d position_m{0.0, 0.0};    ///< centre
  Eigen::Vector2d velocity_mps{0.0, 0.0};  ///< of the centre, over ground
  double heading_rad = 0.0;
  double length_m = 4.5, width_m = 1.8;
  double range_m = 0.0;  ///< from the radar to the nearest point of the box
  double aspect_rad = 0.0;
  bool in_sight = true;  ///< not hidden; every object of a scan is in view

  /// Place in the axes of the body.
  [[nodiscard]] Eigen::Vector2d in_body(const Eigen::Vector2d& place_m) const {
    const double c = std::cos(heading_rad), s = std::sin(heading_rad);
    const Eigen::Vector2d d = place_m - position_m;
    return {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
  }
  /// Depth inside the box: distance to its nearest side, negative outside.
  [[nodiscard]] double depth_m(const Eigen::Vector2d& place_m) const {
    const Eigen::Vector2d p = in_body(place_m);
    const Eigen::Vector2d beyond(std::abs(p.x()) - 0.5 * length_m, std::abs(p.y()) - 0.5 * width_m);
    if (beyond.maxCoeff() <= 0.0) return -beyond.maxCoeff();
    return -beyond.cwiseMax(0.0).norm();
  }
};

struct ObservedDetection {
  Eigen::Vector2d position_m{0.0, 0.0};  ///< by range and azimuth, as if there were no elevation
  double range_m = 0.0;
  double azimuth_rad = 0.0;  ///< sensor frame
  double range_rate_mps = 0.0;
  double rcs_dbsm = 0.0;
  double deviation_mps = 0.0;  ///< range rate less that of a stationary reflector: radial speed over ground
  /// Range rate less that of the rigid body of its object, and the radial speed of this body over ground. NaN: no
  /// direct detection of an object.
  double rigid_deviation_mps = std::numeric_limits<double>::quiet_NaN();
  double body_radial_mps = std::numeric_limits<double>::quiet_NaN();
  double existence = 1.0;
  bool is_valid = true, is_unambiguous = true;  ///< by the sensor's own flags
  bool is_in_box = false;                       ///< within the box of any object
  Provenance provenance = Provenance::kStationary;
  simulator::Cause cause = simulator::Cause::kNone;
  std::uint32_t object = 0;

  /// What the measured data have as labelled: a direct detection of a moving road user.
  [[nodiscard]] bool is_of_mover() const { return provenance == Provenance::kMoving; }
  [[nodiscard]] bool is_direct_of(std::uint32_t id) const {
    return object == id && (provenance == Provenance::kMoving || provenance == Provenance::kStationary);
  }
  [[nodiscard]] bool is_false_mover(double least_mps = kMoving_mps) const {
    return !is_of_mover() && std::abs(deviation_mps) > least_mps;
  }
  [[nodiscard]] bool is_stationary() const { return !is_of_mover() && !is_false_mover(); }
};

struct ObservedScan {
  double t_s = 0.0;
  std::uint32_t radar = 0;
  std::uint64_t number = 0;  ///< of this radar's scans
  Facing facing = Facing::kForward;
  Eigen::Vector2d sensor_m{0.0, 0.0};
  Eigen::Vector2d sensor_velocity_mps{0.0, 0.0};  ///< over ground
  double view_rad = 0.0;                          ///< width of the field of view
  double range_max_m = 0.0;                       ///< of the field of view
  std::vector<ObservedDetection> detections;
  std::vector<ObservedObject> objects;  ///< those in view

  /// Line of sight: unit vector from the sensor to a place.
  [[nodiscard]] Eigen::Vector2d sight_to(const Eigen::Vector2d& place_m) const {
    return (place_m - sensor_m).normalized();
  }
  /// Range rate of the centre of an object.
  [[nodiscard]] double range_rate_mps(const ObservedObject& object) const {
    return sight_to(object.position_m).dot(object.velocity_mps - sensor_velocity_mps);
  }
  [[nodiscard]] const ObservedObject* object(std::uint32_t id) const {
    const auto found = std::find_if(objects.begin(), objects.end(), [id](const auto& o) { return o.id == id; });
    return found == objects.end() ? nullptr : &*found;
  }
};

}  // namespace boresight::bench::realism
