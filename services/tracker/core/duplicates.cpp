#include "services/tracker/core/duplicates.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "services/tracker/core/pieces.hpp"

namespace boresight::tracking {

namespace {

bool are_one(const TrackedObject& a, const TrackedObject& b, const Eigen::Vector2d& sensor, const RulesConfig& config) {
  const Eigen::Vector2d p = a.state.mean.head<2>(), q = b.state.mean.head<2>();
  const Eigen::Vector2d velocity = a.state.mean.segment<2>(2);
  const double apart_mps = (velocity - b.state.mean.segment<2>(2)).norm();
  const bool in_box = a.extent.contains(p, q, 0.0) || b.extent.contains(q, p, 0.0);
  // Two vehicles that have both long been tracked, each at a speed of its own, are two, wherever ghosts draw them. So
  // are a vehicle and a person beside it, whose box may have been drawn to who passes; but a wheel is in its box. The
  // limbs of who walks have their own speeds, too, but neither has a vehicle's length.
  constexpr double kLong_s = 2.0, kOwnSpeed_mps = 2.5, kVehicle_m = 2.5, kDrawn_m = 0.3;
  const bool long_tracked = a.confirmed && b.confirmed && std::min(a.age_s, b.age_s) > kLong_s;
  const bool deep_in_box = a.extent.contains(p, q, 0.0, -kDrawn_m) || b.extent.contains(q, p, 0.0, -kDrawn_m);
  const auto [shorter_m, longer_m] = std::minmax(a.extent.length_m, b.extent.length_m);
  if (long_tracked && apart_mps > kOwnSpeed_mps && (deep_in_box ? shorter_m : longer_m) > kVehicle_m) return false;
  // People who walk different ways pass each other at arm's length, but not through each other, as limbs do.
  constexpr double kOwnWay_mps = 1.5, kShoulders_m = 0.5;
  if (long_tracked && apart_mps > kOwnWay_mps && a.extent.is_small && b.extent.is_small &&
      (p - q).norm() > kShoulders_m) {
    return false;
  }
  if (is_piece_of(a, b, sensor) || is_piece_of(b, a, sensor)) return true;
  // What has its middle in another one's box is no object of its own at whatever velocity: a wheel, or a limb.
  if (in_box) return true;
  if (apart_mps > config.duplicate_speed_mps) return false;
  const double margin_m = config.duplicate_margin_m;
  const bool are_confirmed = a.confirmed && b.confirmed;
  // Two that were confirmed may be vehicles side by side, drawn together as their places are not known well yet.
  const bool are_vehicles = are_confirmed && !a.extent.is_small && !b.extent.is_small;
  // And who is beside a vehicle is no part of it, but for wheels, which are at its side.
  const bool one_is_small = a.extent.is_small != b.extent.is_small;
  constexpr double kWheel_m = 0.5;
  const double beside_m = are_vehicles ? 0.0 : are_confirmed && one_is_small ? std::min(kWheel_m, margin_m) : margin_m;
  if (a.extent.contains(p, q, margin_m, beside_m) || b.extent.contains(q, p, margin_m, beside_m)) return true;
  if (!a.extent.shows_side(p, sensor)) return false;
  // Both ends of a long vehicle: nobody follows so closely, and they move alike. What is new may seem to come over from
  // the next lane.
  constexpr double kSmallestHeadway_s = 0.3, kAlike_mps = 2.0;
  return apart_mps < kAlike_mps && a.extent.in_file(p, b.extent, q, kSmallestHeadway_s * velocity.norm());
}

/// Of what is new and nearer than the end that is seen of the other one, the end that is seen: nothing mirrors to where
/// it is nearer, and nobody who drives follows so closely, so that it is the other one's, whose rear came into sight
/// after its front, or was taken for wheels.
std::optional<Eigen::Vector2d> nearer_end(const TrackedObject& kept, const TrackedObject& gone,
                                          const Eigen::Vector2d& sensor) {
  constexpr double kCreeps_mps = 5.0;
  const Eigen::Vector2d p = kept.state.mean.head<2>(), q = gone.state.mean.head<2>();
  if (!kept.confirmed || kept.state.mean.segment<2>(2).norm() < kCreeps_mps) return std::nullopt;
  // Where one who was taken for a person ends is not known.
  if (kept.extent.is_small || gone.extent.is_small || gone.extent.was_small) return std::nullopt;
  if (kept.extent.contains(p, q, 0.0)) return std::nullopt;
  const double end = kept.extent.visible_faces(p, sensor).end;
  const double at_m = kept.extent.to_body(q - p).x() + 0.5 * end * gone.extent.length_m;
  if (end * at_m <= 0.5 * kept.extent.length_m) return std::nullopt;
  return p + kept.extent.from_body({at_m, 0.0});
}

}  // namespace

void remove_duplicates(std::vector<TrackedObject>& tracks, const Eigen::Vector2d& sensor_m, const RulesConfig& config) {
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    for (std::size_t b = a + 1; b < tracks.size();) {
      if (!are_one(tracks[a], tracks[b], sensor_m, config)) {
        ++b;
        continue;
      }
      if (tracks[b].confirmed && !tracks[a].confirmed) std::swap(tracks[a], tracks[b]);
      TrackedObject& kept = tracks[a];
      const TrackedObject& gone = tracks[b];
      const double speed_mps = (kept.state.mean - gone.state.mean).segment<2>(2).norm();
      const bool shows_side = kept.extent.shows_side(kept.state.mean.head<2>(), sensor_m);
      const bool is_part = gone.confirmed || is_piece_of(gone, kept, sensor_m);
      // What lies behind it in the line of sight may be its ghost, and what moves otherwise another's.
      if (shows_side && speed_mps <= config.duplicate_speed_mps) {
        // What else a part is may be no more than the length of a car that it was born with, so that its middle counts.
        // Of what is new, each time a metre: one wheel that seems to move alike is no rear.
        constexpr double kEachTime_m = 1.0;
        const Eigen::Vector2d centre_m = kept.state.mean.head<2>();
        if (is_part) {
          kept.state.mean.head<2>() = kept.extent.lengthen(centre_m, gone.state.mean.head<2>());
        } else if (const auto end_m = nearer_end(kept, gone, sensor_m)) {
          kept.state.mean.head<2>() = kept.extent.lengthen(centre_m, *end_m, kEachTime_m);
        }
      }
      tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(b));
    }
  }
}

}  // namespace boresight::tracking
