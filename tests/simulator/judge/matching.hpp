// Which track is which object's, one to one.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/track_list.hpp"
#include "tests/simulator/judge/object.hpp"

namespace boresight::judge {

/// Farther than this from an object's box a track cannot be the object's.
inline constexpr double kMaxTrackDistance_m = 3.0;
inline constexpr std::size_t kNone = static_cast<std::size_t>(-1);

struct Matching {
  std::vector<std::size_t> track_of_object;  ///< kNone: it has none
  std::vector<std::size_t> object_of_track;  ///< of the first tracks of the list, as many as were asked for
};

/// The first `number_of_tracks` of the list (the confirmed ones come first) with the objects, nearest pairs first: one
/// vehicle's track is not its neighbour's as well, and a second track beside a vehicle is nobody's; one in a vehicle's
/// box is that vehicle's or nobody's. Those objects that are hidden come last: they take no track from what is seen
/// beside them.
[[nodiscard]] Matching match(const TrackList& tracks, std::size_t number_of_tracks, const std::vector<Object>& objects);

[[nodiscard]] inline Eigen::Vector2d place_of(const Track& track) {
  return {track.position_vehicle_m[0], track.position_vehicle_m[1]};
}

}  // namespace boresight::judge
