#include "services/tracker/core/stopped.hpp"

#include <algorithm>

namespace boresight::tracking {

namespace {

/// Rails and walls stand, too. But what lies along a side or an end of the box and is not much longer is just that, as
/// the map has it.
bool is_of_reflector(const ClassifiedScan& scan, const Eigen::Vector2d& place_m, const TrackedObject& track) {
  constexpr double kNear_m = 0.7;
  // By so much boxes are too short or lie too far ahead, and reflectors in the map are too long: their ends are found
  // in steps of 4 m, and images of the rear in the vehicles beside lengthen it, too.
  constexpr double kLonger_m = 6.0, kBeside_m = 1.0;
  const auto is_own = [&track](const Eigen::Vector2d& end_m, bool lies_across) {
    return track.extent.contains(track.state.mean.head<2>(), end_m, lies_across ? kBeside_m : kLonger_m,
                                 lies_across ? kLonger_m : kBeside_m);
  };
  const std::size_t count = std::min<std::size_t>(scan.number_of_reflector_segments, kMaxReflectorSegments);
  return std::any_of(scan.reflector_segments.begin(),
                     scan.reflector_segments.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const ReflectorSegment& segment) {
                       const Eigen::Vector2d from(segment.start_vehicle_m[0], segment.start_vehicle_m[1]),
                           to(segment.end_vehicle_m[0], segment.end_vehicle_m[1]);
                       const Eigen::Vector2d along = to - from, in_body = track.extent.to_body(along).cwiseAbs();
                       const bool lies_across = in_body.y() > in_body.x();
                       if (is_own(from, lies_across) && is_own(to, lies_across)) return false;
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
