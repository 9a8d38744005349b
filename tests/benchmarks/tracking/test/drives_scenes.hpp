// Hand-made track lists and objects for the tests of drives/.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/benchmarks/tracking/drives/judge/scene.hpp"

namespace boresight::bench::tracking::made {

/// A car at rest in the axes of the vehicle, 4 m × 2 m, which drives 10 m/s ahead.
inline judge::TrueObject car(std::uint32_t id, double x_m, double y_m = 0.0) {
  judge::TrueObject object;
  object.box.id = id;
  object.box.position_m = {x_m, y_m};
  object.box.velocity_mps = {10.0, 0.0};
  object.box.heading_rad = 0.0;
  object.box.length_m = 4.0;
  object.box.width_m = 2.0;
  object.object_class = ObjectClass::kCar;
  return object;
}

inline ListedTrack track(std::uint32_t id, double x_m, double y_m, double score) {
  ListedTrack track;
  track.id = id;
  track.movement = MovementState::kMoving;
  track.position_m = {x_m, y_m};
  track.length_m = 4.0;
  track.width_m = 2.0;
  track.position_covariance_m2 = Eigen::Matrix2d::Identity();
  track.score = score;
  return track;
}

inline Scene scene(double t_s, std::vector<ListedTrack> tracks, std::vector<judge::TrueObject> objects) {
  return {t_s, std::move(tracks), std::move(objects)};
}

}  // namespace boresight::bench::tracking::made
