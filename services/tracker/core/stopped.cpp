#include "services/tracker/core/stopped.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {

/// Whether the segment is what the map makes of the vehicle itself.
bool is_own(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m, const TrackedObject& track) {
  // By so much boxes are too short or lie too far ahead, and reflectors in the map are too long: their ends are found
  // in steps of 4 m, and images of an end in the vehicles beside lengthen it, too.
  constexpr double kLonger_m = 6.0, kBeside_m = 1.0;
  const Extent& box = track.extent;
  const Eigen::Vector2d centre_m = track.state.mean.head<2>();
  const Eigen::Vector2d from = box.to_body(from_m - centre_m), along = box.to_body(to_m - from_m);
  const bool lies_across = std::abs(along.y()) > std::abs(along.x());
  if (lies_across && !box.is_small) {
    // Who drives forward came through where the rear is: no wall is there, however long it looks.
    const double share = std::clamp(-from.dot(along) / std::max(1e-6, along.squaredNorm()), 0.0, 1.0);
    const double at_m = from.x() + share * along.x();
    if (at_m < 0.0 && at_m > -0.5 * box.length_m - kBeside_m) return true;
  }
  const double ahead_m = lies_across ? kBeside_m : kLonger_m, beside_m = lies_across ? kLonger_m : kBeside_m;
  return box.contains(centre_m, from_m, ahead_m, beside_m) && box.contains(centre_m, to_m, ahead_m, beside_m);
}

/// Rails and walls stand, too.
bool is_of_reflector(const ClassifiedScan& scan, const Eigen::Vector2d& place_m, const TrackedObject& track) {
  constexpr double kNear_m = 0.7;
  const std::size_t count = std::min<std::size_t>(scan.number_of_reflector_segments, kMaxReflectorSegments);
  return std::any_of(scan.reflector_segments.begin(),
                     scan.reflector_segments.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const ReflectorSegment& segment) {
                       const Eigen::Vector2d from(segment.start_vehicle_m[0], segment.start_vehicle_m[1]),
                           to(segment.end_vehicle_m[0], segment.end_vehicle_m[1]);
                       if (is_own(from, to, track)) return false;
                       const Eigen::Vector2d along = to - from;
                       const double share = (place_m - from).dot(along) / std::max(1e-6, along.squaredNorm());
                       return (place_m - from - std::clamp(share, 0.0, 1.0) * along).norm() < kNear_m;
                     });
}

}  // namespace

void keep_stopped(std::span<TrackedObject> tracks, const ClassifiedScan& scan) {
  // Ghosts' tracks, too, come to rest on what stands somewhere, but do not live so long before.
  constexpr double kLongEnough_s = 5.0, kSure = 0.9;
  constexpr double kAround_m = 0.5;  // what the filter does not know of where the faces are
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (TrackedObject& track : tracks) {
    if (!track.confirmed || !track.slow || track.detections > 0 || track.age_s < kLongEnough_s ||
        track.existence < kSure) {
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (scan.provenance[i] != Provenance::kStationary) continue;
      const Eigen::Vector2d place(scan.x_vehicle_m[i], scan.y_vehicle_m[i]);
      if (!track.extent.contains(track.state.mean.head<2>(), place, kAround_m) || is_of_reflector(scan, place, track))
        continue;
      come_to_rest(track.state);
      track.since_update_s = 0.0;
      break;
    }
  }
}

}  // namespace boresight::tracking
