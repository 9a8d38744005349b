// Features of a cluster: what its detections tell of an object's place, size, strength and motion. The list is that of
// the 4D chain design.
#pragma once

#include <limits>
#include <span>

#include "services/tracker/core/ggiw/planar.hpp"

namespace boresight::tracking {

/// One detection of a cluster. Positions and directions are in the axes of the caller's choice, the same for all.
struct ClusterPoint {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Vector2<double> position_m;
  Vector2<double> sight;          ///< unit vector from the sensor
  double height_m = kUnknown;     ///< above the road; unknown without elevation
  double range_m = 0.0;           ///< from the sensor
  double range_rate_mps = 0.0;    ///< over ground
  double strength_db = kUnknown;  ///< RCS over the radar's level
  double snr_db = kUnknown;       ///< the same of the signal-to-noise ratio
  double weight = 1.0;            ///< share of the detection that is the cluster's, 0…1
};

/// Of one quantity, over the points that state it. Without any, all but the number is unknown.
struct ClusterStatistics {
  double number = 0.0;  ///< sum of weights
  double mean = ClusterPoint::kUnknown, std = ClusterPoint::kUnknown;
  double least = ClusterPoint::kUnknown, largest = ClusterPoint::kUnknown;
};

struct ClusterFeatures {
  double points = 0.0;                        ///< sum of weights
  Vector2<double> centre_m;                   ///< weighted mean; unknown without points
  double axis_rad = ClusterPoint::kUnknown;   ///< direction of the length
  double length_m = ClusterPoint::kUnknown;   ///< full extent along the axis …
  double width_m = ClusterPoint::kUnknown;    ///< … and across
  double height_m = ClusterPoint::kUnknown;   ///< extent in height; unknown without elevation
  double volume_m3 = ClusterPoint::kUnknown;  ///< length · width · height
  double area_m2 = ClusterPoint::kUnknown;    ///< of the box projected on the road: length · width
  double depth_m = ClusterPoint::kUnknown;    ///< extent in range
  Symmetric2<double> covariance_m2;           ///< of the positions about the centre
  double along_std_m = ClusterPoint::kUnknown, across_std_m = ClusterPoint::kUnknown;  ///< in the axes of the box
  ClusterStatistics elevation_m;  ///< heights: centre z, and their deviation
  ClusterStatistics strength_db, snr_db, range_rate_mps, range_m;
};

/// Along the given direction. Points with a place or weight that is not finite, or without weight, are not included.
[[nodiscard]] ClusterFeatures cluster_features(std::span<const ClusterPoint> points, double heading_rad);
/// Along the principal axis of the positions; along the mean line of sight if no direction is longer than another.
[[nodiscard]] ClusterFeatures cluster_features(std::span<const ClusterPoint> points);

}  // namespace boresight::tracking
