// Which tracks are pieces of one long vehicle: a truck reflects at its rear, its axles and little between. Pieces drive
// in file, nearer than most would follow, and keep their distance.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// Notes of each vehicle that has just been detected how it keeps its distance to a confirmed one before or behind it
/// that has been tracked for longer. `sensor_m`, vehicle frame: from where the scan saw them.
void watch_pieces(std::vector<TrackedObject>& tracks, const Eigen::Vector2d& sensor_m);

/// Age of the track until which it is not known whether it is another one's piece, in s; 0: it is none.
[[nodiscard]] double piece_wait_s(const TrackedObject& track);

/// Whether the track has kept its distance to the other one for long enough, and still drives in file with it.
[[nodiscard]] bool is_piece_of(const TrackedObject& track, const TrackedObject& other, const Eigen::Vector2d& sensor_m);

}  // namespace boresight::tracking
