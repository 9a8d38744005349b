#include "services/simulator/judge/matching.hpp"

#include <algorithm>
#include <tuple>

namespace boresight::judge {

Matching match(const TrackList& tracks, std::size_t number_of_tracks, const std::vector<Object>& objects) {
  Matching out{std::vector<std::size_t>(objects.size(), kNone), std::vector<std::size_t>(number_of_tracks, kNone)};
  // The track of a long vehicle may lie at either end. So pairs are ordered by the distance from the box first, and
  // inside the box by the distance from its centre.
  std::vector<std::tuple<bool, double, double, std::size_t, std::size_t>> pairs;
  for (std::size_t k = 0; k < number_of_tracks; ++k) {
    const Eigen::Vector2d place = place_of(tracks.tracks[k]);
    const bool in_box = std::any_of(objects.begin(), objects.end(), [&place](const Object& object) {
      return !object.is_hidden && object.distance_m(place) <= 0.0;
    });
    for (std::size_t o = 0; o < objects.size(); ++o) {
      const double distance_m = objects[o].distance_m(place);
      if (!(distance_m < kMaxTrackDistance_m) || (in_box && distance_m > 0.0)) continue;
      pairs.emplace_back(objects[o].is_hidden, distance_m, (objects[o].position_m - place).norm(), k, o);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [is_hidden, box_m, middle_m, k, o] : pairs) {
    if (out.object_of_track[k] != kNone || out.track_of_object[o] != kNone) continue;
    out.object_of_track[k] = o;
    out.track_of_object[o] = k;
  }
  return out;
}

}  // namespace boresight::judge
