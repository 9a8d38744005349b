// One-to-one assignment of tracks to objects.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/track_list.hpp"
#include "services/simulator/judge/object.hpp"

namespace boresight::judge {

/// Largest distance of a track from the box of its object.
inline constexpr double kMaxTrackDistance_m = 3.0;
inline constexpr std::size_t kNone = static_cast<std::size_t>(-1);

struct Matching {
  std::vector<std::size_t> track_of_object;  ///< kNone: the object has no track
  std::vector<std::size_t> object_of_track;  ///< of the first `number_of_tracks` tracks of the list
};

/// Assigns the first `number_of_tracks` tracks of the list (confirmed tracks come first) to objects, nearest pair
/// first. Each track has at most one object and each object at most one track; further tracks near an object have none.
/// A track inside an object's box is assigned to that object or to none. Hidden objects come last, so that they take no
/// track from a visible object.
[[nodiscard]] Matching match(const TrackList& tracks, std::size_t number_of_tracks, const std::vector<Object>& objects);

[[nodiscard]] inline Eigen::Vector2d place_of(const Track& track) {
  return {track.position_vehicle_m[0], track.position_vehicle_m[1]};
}

}  // namespace boresight::judge
