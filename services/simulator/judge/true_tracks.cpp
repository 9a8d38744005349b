#include "services/simulator/judge/true_tracks.hpp"

#include <algorithm>

namespace boresight::judge {

namespace {

/// By the size, which the judge's objects have; the limits lie between the classes of object_classes.toml.
ObjectClass class_of(const Object& object) {
  constexpr double kShortestTruck_m = 7.0, kShortestCar_m = 3.0, kShortestTwoWheeler_m = 1.2;
  if (object.length_m >= kShortestTruck_m) return ObjectClass::kTruck;
  if (object.length_m >= kShortestCar_m) return ObjectClass::kCar;
  return object.length_m >= kShortestTwoWheeler_m ? ObjectClass::kTwoWheeler : ObjectClass::kPedestrian;
}

}  // namespace

void TrueTracks::write(double t_s, const std::vector<Object>& objects, TrackList& out) {
  out.number_of_tracks = out.number_of_confirmed_tracks = 0;
  out.flags = out.dropped_tracks = out.tracker_flags = out.likelihood_evaluations = 0;
  for (const Object& object : objects) {
    if (object.is_hidden) {
      known_since_s_.erase(object.id);
      continue;
    }
    known_since_s_.emplace(object.id, t_s);
    if (out.number_of_tracks == kMaxTracks) continue;
    Track& track = out.tracks[out.number_of_tracks++] = {};
    ++out.number_of_confirmed_tracks;
    track.tracking_id = object.id;
    track.status = TrackStatus::kConfirmed;
    track.movement = MovementState::kMoving;
    track.object_class = class_of(object);
    track.class_probability[static_cast<std::size_t>(track.object_class)] = 1.0F;
    track.age_s = static_cast<float>(age_s(object.id, t_s));
    track.existence_probability = 1.0F;
    track.heading_rad = static_cast<float>(object.heading_rad);
    track.length_m = static_cast<float>(object.length_m);
    track.width_m = static_cast<float>(object.width_m);
    track.position_vehicle_m = {static_cast<float>(object.position_m.x()), static_cast<float>(object.position_m.y()),
                                0.0F};
    track.velocity_over_ground_mps = {static_cast<float>(object.velocity_mps.x()),
                                      static_cast<float>(object.velocity_mps.y())};
  }
}

double TrueTracks::age_s(std::uint32_t object, double t_s) const {
  const auto since = known_since_s_.find(object);
  return since == known_since_s_.end() ? -1.0 : t_s - since->second;
}

}  // namespace boresight::judge
