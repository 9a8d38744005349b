// Classes of objects in a profile, and the aspect of an object.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "services/simulator/scene.hpp"

namespace boresight::simulator::radar {

enum class ObjectClass : std::uint8_t { kCar, kTruck, kTwoWheeler, kPedestrian, kStandingVehicle, kStandingTruck };

[[nodiscard]] inline ObjectClass class_of(BodyKind kind, bool moving) {
  switch (kind) {
    case BodyKind::kCar:
    case BodyKind::kVan:
      return moving ? ObjectClass::kCar : ObjectClass::kStandingVehicle;
    case BodyKind::kTruck:
      return moving ? ObjectClass::kTruck : ObjectClass::kStandingTruck;
    case BodyKind::kCyclist:
      return ObjectClass::kTwoWheeler;
    case BodyKind::kPedestrian:
      break;
  }
  return ObjectClass::kPedestrian;
}

/// The entry of a table with one entry for each class.
template <typename Table, typename Entry>
[[nodiscard]] const Entry& entry_of(ObjectClass c, const Table& t, Entry Table::*car, Entry Table::*truck,
                                    Entry Table::*two_wheeler, Entry Table::*pedestrian, Entry Table::*standing,
                                    Entry Table::*standing_truck) {
  switch (c) {
    case ObjectClass::kCar:
      return t.*car;
    case ObjectClass::kTruck:
      return t.*truck;
    case ObjectClass::kTwoWheeler:
      return t.*two_wheeler;
    case ObjectClass::kStandingVehicle:
      return t.*standing;
    case ObjectClass::kStandingTruck:
      return t.*standing_truck;
    case ObjectClass::kPedestrian:
      break;
  }
  return t.*pedestrian;
}

[[nodiscard]] inline bool is_vehicle(BodyKind kind) {
  return kind == BodyKind::kCar || kind == BodyKind::kVan || kind == BodyKind::kTruck;
}

/// Range of a body: to the nearest point of its box, as detections measure it. The centre of a truck is up to half its
/// length farther.
[[nodiscard]] inline double range_of(const Body& body, const Eigen::Vector2d& sensor_m) {
  const double c = std::cos(body.heading_rad), s = std::sin(body.heading_rad);
  const Eigen::Vector2d offset = sensor_m - body.position_m;
  const double ahead = std::abs(c * offset.x() + s * offset.y()) - 0.5 * body.length_m;
  const double aside = std::abs(c * offset.y() - s * offset.x()) - 0.5 * body.width_m;
  return std::hypot(std::max(0.0, ahead), std::max(0.0, aside));
}

/// Angle between the body's heading and the line of sight, 0 … π: 0 from behind, π from ahead.
[[nodiscard]] inline double aspect_of(const Body& body, const Eigen::Vector2d& sensor_m) {
  const Eigen::Vector2d sight = body.position_m - sensor_m;
  return std::abs(std::remainder(std::atan2(sight.y(), sight.x()) - body.heading_rad, 2.0 * M_PI));
}

/// A value by aspect: constant within 30° of rear and front and within 30° of abeam, linear between.
[[nodiscard]] inline double by_aspect(double aspect_rad, double rear, double side, double front) {
  constexpr double kSector_rad = M_PI / 6.0;
  const double end = aspect_rad < 0.5 * M_PI ? rear : front;
  const double from_end = std::min(aspect_rad, M_PI - aspect_rad);
  const double share = std::clamp((from_end - kSector_rad) / kSector_rad, 0.0, 1.0);
  return end + share * (side - end);
}

}  // namespace boresight::simulator::radar
