#include "services/tracker/core/images.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {

struct Sighting {
  Eigen::Vector2d sight;  ///< unit vector to the track
  double range_m;
};

Sighting view_of(const TrackedObject& track, const Eigen::Vector2d& sensor_m) {
  const Eigen::Vector2d sight = track.state.mean.head<2>() - sensor_m;
  const double range_m = std::max(1e-3, sight.norm());
  return {sight / range_m, range_m};
}

/// How much farther from the middle than a car's the ends of a long one are.
double longer_m(const TrackedObject& track) {
  return std::max(0.0, 0.5 * (track.extent.length_m - Extent::kCarLength_m));
}

bool may_be_image_of(const TrackedObject& track, const Sighting& seen, const TrackedObject& other,
                     const Eigen::Vector2d& sensor_m) {
  constexpr double kYounger_s = 0.5;  // both may have come into sight at once, or one been missed at first
  constexpr double kLoss_db = 3.0;    // at the least, of what each bounce costs
  // A detour by the lane beside, and what is not known of where the middle of a new track is.
  constexpr double kMostDetour_m = 8.0, kNearer_m = 1.5;
  // Of the speed: mirrors are not quite parallel to the course. In a jam, lanes differ by hardly more than the least.
  constexpr double kAlikeShare = 0.15, kLeastAlike_mps = 0.2, kMostAlike_mps = 0.8;
  // Written so that what was never heard is nothing's image.
  if (other.age_s < track.age_s - kYounger_s ||
      !(other.extent.strongest_dbsm > track.extent.strongest_dbsm + kLoss_db)) {
    return false;
  }
  const Sighting from = view_of(other, sensor_m);
  // Of a long one, any part may be what is mirrored.
  const double part_m = longer_m(other);
  if (seen.range_m < from.range_m - part_m - kNearer_m || seen.range_m > from.range_m + part_m + kMostDetour_m) {
    return false;
  }
  // In a mirror along the road an image drives as its object does; out there and back here it shows a bit of both.
  const Eigen::Vector2d velocity = other.state.mean.segment<2>(2);
  const double rate_mps = seen.sight.dot(track.state.mean.segment<2>(2));
  const double alike_mps = std::clamp(kAlikeShare * velocity.norm(), kLeastAlike_mps, kMostAlike_mps);
  return std::abs(rate_mps - from.sight.dot(velocity)) < alike_mps ||
         std::abs(rate_mps - seen.sight.dot(velocity)) < alike_mps;
}

/// Whether the vehicle's side, the one that is seen, would show the other one where the track is.
bool shows_in_side(const TrackedObject& vehicle, const TrackedObject& other, const TrackedObject& track,
                   const Eigen::Vector2d& sensor_m) {
  // Of where the middles of new tracks are, and how wide the vehicle is, that much is not known; and of the heading of
  // one that is new itself, whatever its track says.
  constexpr double kAlong_m = 3.0, kAcross_m = 1.5, kNewHeading_rad = 0.1, kNew_s = 2.0;
  if (!vehicle.confirmed || vehicle.extent.is_small) return false;
  const Eigen::Vector2d centre_m = vehicle.state.mean.head<2>();
  const double side = vehicle.extent.visible_faces(centre_m, sensor_m).side;
  const Eigen::Vector2d object = vehicle.extent.to_body(other.state.mean.head<2>() - centre_m);
  const Eigen::Vector2d image = vehicle.extent.to_body(track.state.mean.head<2>() - centre_m);
  const double face_m = 0.5 * side * vehicle.extent.width_m;
  const double known_rad = std::sqrt(std::max(0.0, vehicle.state.heading.variance));
  const bool is_new = vehicle.age_s < kNew_s || !vehicle.state.heading.known;
  // A mirror that turns by so much turns what it shows by twice as much.
  const double turn_rad = 2.0 * (is_new ? std::max(kNewHeading_rad, known_rad) : known_rad);
  return side != 0.0 && std::abs(image.x() - object.x()) < kAlong_m + longer_m(other) &&
         std::abs(image.y() + object.y() - 2.0 * face_m) < kAcross_m + turn_rad * std::abs(image.x());
}

}  // namespace

double image_wait_s(const TrackedObject& track, std::span<const TrackedObject> tracks, const Eigen::Vector2d& sensor_m,
                    const RulesConfig& config) {
  const Sighting seen = view_of(track, sensor_m);
  double wait_s = 0.0;
  for (const TrackedObject& other : tracks) {
    if (&other == &track || !may_be_image_of(track, seen, other, sensor_m)) continue;
    wait_s = std::max(wait_s, config.confirm_image_age_s);
    const bool in_side = std::any_of(tracks.begin(), tracks.end(), [&](const TrackedObject& vehicle) {
      return &vehicle != &track && &vehicle != &other && shows_in_side(vehicle, other, track, sensor_m);
    });
    if (in_side) return std::max(wait_s, config.confirm_side_image_age_s);
  }
  return wait_s;
}

}  // namespace boresight::tracking
