// Where the road heads for on which the own vehicle drives.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "interfaces/messages/corrected_scan.hpp"

namespace boresight::tracking {

/// The road as the own course tells it, without a map: a circle of its curvature, straight on where the own vehicle is
/// too slow to show one.
class OwnRoad {
 public:
  OwnRoad() = default;
  explicit OwnRoad(const ScanGeometry& geometry);

  /// Its direction at a place far away (m, vehicle frame), rad in vehicle axes, and as well its opposite: who drives
  /// there goes either way. Nothing nearer than 30 m, where places soon tell how who is new drives, and those are who
  /// cross; beside the lanes next to the own one; and where a bend has turned so far that the own course says little.
  [[nodiscard]] std::optional<double> heading_rad(const Eigen::Vector2d& at_m) const;

 private:
  double curvature_per_m_ = 0.0;
};

}  // namespace boresight::tracking
