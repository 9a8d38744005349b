// Whether the vehicle meets an object on its path, when, and how sure that is. Equations (W11)…(W14).
#pragma once

#include <Eigen/Core>

#include "services/tracker/core/surroundings/ego_path.hpp"
#include "services/tracker/core/surroundings/parameters.hpp"
#include "services/tracker/core/surroundings/road_edges.hpp"

namespace boresight::tracking {

/// A box with constant velocity, in the vehicle frame; velocities over ground.
struct MeetingObject {
  Eigen::Vector2d position_m{0.0, 0.0}, velocity_mps{0.0, 0.0};
  /// Rows: x, y, v_x, v_y.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double heading_rad = 0.0, length_m = 0.0, width_m = 0.0;
};

struct Meeting {
  bool is_ahead = false;  ///< before the vehicle's front; all else is valid only then
  double time_s;          ///< until the vehicle's front reaches the object's nearest face; +infinity: never
  double time_std_s;
  double closing_mps;        ///< along the path
  double deceleration_mps2;  ///< constant one with which the vehicle would just not reach the object
  double
      lateral_mps2;  ///< constant lateral acceleration with which the vehicle would just pass beside it; < 0: it does
  double offset_m, offset_std_m;  ///< of the object's centre from the path at that time, + left
  Eigen::Vector2d place_m;        ///< of the object's centre then, in the vehicle frame of now
  double object_std_m;            ///< of that place across the path
  double probability;             ///< that the outlines overlap across the path then
  double length_m, width_m;       ///< of the object along and across the path
};

[[nodiscard]] Meeting meeting(const MeetingObject& object, const EgoPath& path, const CollisionParameters& parameters);

/// Takes into account that the vehicle may follow the road: `course` of the object's place at the meeting.
void follow_road(const RoadCourse& course, const CollisionParameters& parameters, Meeting& m);

}  // namespace boresight::tracking
