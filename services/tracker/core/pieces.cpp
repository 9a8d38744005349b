#include "services/tracker/core/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::tracking {

namespace {

constexpr double kSettled_s = 1.0;  // until then a new track is not where it is for good
constexpr double kLong_s = 3.0;     // two drivers hardly keep their distance to a hand's width for so long

bool is_in_file(const TrackedObject& track, const TrackedObject& other, double gap_m, double besides_m) {
  return other.extent.in_file(other.state.mean.head<2>(), track.extent, track.state.mean.head<2>(), gap_m, besides_m);
}

/// So near before or behind that it may be a piece of the other one, and seen from beside: else what lies behind is as
/// likely a type-1 ghost.
bool is_close_in_file(const TrackedObject& track, const TrackedObject& other, const Eigen::Vector2d& sensor_m) {
  // The gap is that between axles, or an axle and an end. Of whose flank alone is seen the middle is known to half a
  // width; lanes are wider.
  constexpr double kGap_m = 4.2, kBesides_m = 1.5;
  return other.extent.shows_side(other.state.mean.head<2>(), sensor_m) && is_in_file(track, other, kGap_m, kBesides_m);
}

/// Too far before or behind to be a piece, whatever its first scans made of its place. How far aside says nothing: far
/// ahead noise moves it by a lane.
bool has_left(const TrackedObject& track, const TrackedObject& other) {
  constexpr double kLeft_m = 6.0;
  return !is_in_file(track, other, kLeft_m, std::numeric_limits<double>::infinity());
}

/// Which of the tracks may be what this one is a piece of.
bool may_be_whole(const TrackedObject& other, const TrackedObject& track, const Eigen::Vector2d& sensor_m) {
  constexpr double kAlike_mps = 0.6;
  if (&other == &track || !other.confirmed || other.extent.is_small || other.age_s < track.age_s) return false;
  const Eigen::Vector2d apart_mps = other.extent.to_body((track.state.mean - other.state.mean).segment<2>(2));
  return std::abs(apart_mps.x()) < kAlike_mps && is_close_in_file(track, other, sensor_m);
}

/// Along the other one's axis, of the end that is seen, which a track knows best: middles move as boxes grow.
double seen_end_m(const TrackedObject& track, const Extent& axes, const Eigen::Vector2d& sensor_m) {
  const Eigen::Vector2d centre_m = track.state.mean.head<2>();
  return axes.to_body(centre_m).x() + 0.5 * track.extent.visible_faces(centre_m, sensor_m).end * track.extent.length_m;
}

/// How far apart they were at first, a mean over a second, and how far they are now. What is seen of a piece changes
/// with the way it is seen from, by an axle that comes into sight: after a small step the distance is measured anew.
/// All steps together count from the first mean on: where a single scan has a new track may be a metre off.
void measure(Companion& companion, double age_s, double apart_m) {
  constexpr double kFirst_s = 1.0, kGain = 0.1, kMoved_m = 0.3, kOwnWay_m = 0.8;
  if (age_s < companion.since_age_s) return;
  if (age_s - companion.since_age_s < kFirst_s) {
    companion.first_m += (apart_m - companion.first_m) / ++companion.scans;
    companion.now_m = companion.first_m;
  } else {
    if (!companion.has_begun) companion.begun_m = companion.first_m;
    companion.has_begun = true;
    companion.now_m += kGain * (apart_m - companion.now_m);
  }
  const bool is_off = companion.has_begun && std::abs(companion.now_m - companion.begun_m) > kOwnWay_m;
  companion.is_apart = companion.is_apart || is_off;
  if (std::abs(companion.now_m - companion.first_m) <= kMoved_m) return;
  companion.since_age_s = age_s;
  companion.scans = 0;
}

}  // namespace

void watch_pieces(std::vector<TrackedObject>& tracks, const Eigen::Vector2d& sensor_m) {
  for (TrackedObject& track : tracks) {
    if (track.extent.is_small || track.detections == 0) continue;
    Companion& companion = track.companion;
    auto other = std::find_if(tracks.begin(), tracks.end(),
                              [&](const TrackedObject& o) { return &o != &track && o.id == companion.id; });
    if (other == tracks.end() || has_left(track, *other)) {
      companion = {};
      other = std::find_if(tracks.begin(), tracks.end(),
                           [&](const TrackedObject& o) { return may_be_whole(o, track, sensor_m); });
      if (other == tracks.end()) continue;
    }
    const Extent& axes = other->extent;
    const double apart_m = seen_end_m(track, axes, sensor_m) - seen_end_m(*other, axes, sensor_m);
    if (companion.id == 0) {
      companion.id = other->id;
      companion.since_age_s = std::max(track.age_s, kSettled_s);
    }
    measure(companion, track.age_s, apart_m);
  }
}

double piece_wait_s(const TrackedObject& track) {
  const Companion& companion = track.companion;
  return companion.id == 0 || companion.is_apart ? 0.0 : companion.since_age_s + kLong_s;
}

bool is_piece_of(const TrackedObject& track, const TrackedObject& other, const Eigen::Vector2d& sensor_m) {
  const Companion& companion = track.companion;
  return companion.id == other.id && !companion.is_apart && track.age_s - companion.since_age_s > kLong_s &&
         is_close_in_file(track, other, sensor_m);
}

}  // namespace boresight::tracking
