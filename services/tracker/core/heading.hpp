// Where a vehicle heads for, as a part of its kinematic state: its velocity goes along it, but for a little slip, so
// that places and range rates over time tell it, and what lies along its flank tells its velocity.
#pragma once

#include "services/tracker/core/kalman.hpp"

namespace boresight::tracking {

/// A measurement of the heading, as its difference from the one that is known, with its variance (rad²).
struct Turn {
  double difference_rad;
  double variance;
};

/// Takes the course, the direction of the velocity over ground, for the heading, once that is known to a quarter of a
/// radian (and it drives faster than 0.5 m/s): before, `state.heading` is not known.
void begin_heading(KinematicState& state);

/// The same by the line of a flank, of a track whose box heads for `box_heading_rad`: the course of who creeps is never
/// known well enough.
void begin_heading(KinematicState& state, double box_heading_rad, const Turn& turn);

/// The same by the road on which it drives, which heads for `road_rad` (vehicle axes) or comes from there: if what is
/// known of the velocity so far is little, but rather along that road than across.
void begin_heading(KinematicState& state, double road_rad);

/// A vehicle's heading after `elapsed_s` in the new vehicle frame, which has turned by `turned_rad`: it has turned as
/// vehicles do, the less the slower it is.
void predict_heading(KinematicState& state, double elapsed_s, double turned_rad);

/// Vehicles do not move across their heading, but for some slip, and as their centre is not above their rear axle.
void hold_to_heading(KinematicState& state);

void measure_heading(KinematicState& state, const Turn& turn);

}  // namespace boresight::tracking
