#include "services/tracker/core/images.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {

struct View {
  Eigen::Vector2d sight;  ///< unit vector to the track
  double range_m;
};

View view_of(const TrackedObject& track, const Eigen::Vector2d& sensor_m) {
  const Eigen::Vector2d sight = track.state.mean.head<2>() - sensor_m;
  const double range_m = std::max(1e-3, sight.norm());
  return {sight / range_m, range_m};
}

bool may_be_image_of(const TrackedObject& track, const View& seen, const TrackedObject& other,
                     const Eigen::Vector2d& sensor_m) {
  constexpr double kYounger_s = 0.1;  // both may have come into sight at once
  constexpr double kLoss_db = 3.0;    // at the least, of what each bounce costs
  // A detour by the lane beside, and what is not known of where the middle of a new track is.
  constexpr double kMostDetour_m = 8.0, kNearer_m = 1.5;
  constexpr double kAlike_mps = 0.8;
  // Written so that what was never heard is nothing's image.
  if (other.age_s < track.age_s - kYounger_s ||
      !(other.extent.strongest_dbsm > track.extent.strongest_dbsm + kLoss_db)) {
    return false;
  }
  const View from = view_of(other, sensor_m);
  if (seen.range_m < from.range_m - kNearer_m || seen.range_m > from.range_m + kMostDetour_m) return false;
  // In a mirror along the road an image drives as its object does; out there and back here it shows a bit of both.
  const Eigen::Vector2d velocity = other.state.mean.segment<2>(2);
  const double rate_mps = seen.sight.dot(track.state.mean.segment<2>(2));
  return std::abs(rate_mps - from.sight.dot(velocity)) < kAlike_mps ||
         std::abs(rate_mps - seen.sight.dot(velocity)) < kAlike_mps;
}

}  // namespace

bool may_be_image(const TrackedObject& track, std::span<const TrackedObject> tracks, const Eigen::Vector2d& sensor_m) {
  const View seen = view_of(track, sensor_m);
  return std::any_of(tracks.begin(), tracks.end(), [&](const TrackedObject& other) {
    return &other != &track && may_be_image_of(track, seen, other, sensor_m);
  });
}

}  // namespace boresight::tracking
