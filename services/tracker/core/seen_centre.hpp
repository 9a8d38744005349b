// Where a tracked box's middle is by what one scan shows of it.
#pragma once

#include <Eigen/Core>

#include "services/tracker/core/clusters.hpp"
#include "services/tracker/core/extent.hpp"

namespace boresight::tracking {

struct SeenCentre {
  Eigen::Vector2d at_m;           ///< vehicle frame
  Eigen::Matrix2d covariance_m2;  ///< by the sensor's noise and by where on the box a detection may be
};

/// Each detection is of that face of those that look to the sensor which is nearest to it, if the box is where it was
/// thought to be: it tells where that face is, and lies anywhere along it. So an end says how far away a vehicle is and
/// a flank how far beside, however many detections either has. The mean of all, taken for the middle of what is seen,
/// is half a metre off towards the face with more of them. What is farther off than the rest counts the less.
/// `position_m2`: covariance of `centre_m`, the middle as it was predicted. People and cycles have no faces: what is
/// seen is of their middle.
[[nodiscard]] SeenCentre seen_centre(const Cluster& cluster, const Extent& extent, const Eigen::Vector2d& centre_m,
                                     const Eigen::Matrix2d& position_m2, const Eigen::Vector2d& sensor_m);

}  // namespace boresight::tracking
