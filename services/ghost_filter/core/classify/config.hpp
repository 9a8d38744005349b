// Settings of the classification by mirror consistency.
#pragma once

namespace boresight::ghosts {

/// Densities are expected numbers of detections in a scan for each square metre and each m/s of range rate.
struct ClassConfig {
  double decision_probability = 0.5;  ///< from here on a detection is called a ghost (or clutter)
  double memory_s = 0.2;              ///< moving detections of this time can be what a ghost mirrors
  double sighting_s = 1.0;            ///< … and of this time what is detected again, moved on
  double new_object_density = 4e-6;   ///< of real moving objects that nothing announces
  double clutter_density = 2e-6;
  double lone_ghost_density = 1e-6;  ///< of type-2 ghosts behind a reflector whose object is not seen
  double hidden_ghost_density =
      4e-5;                       ///< for each m²: of type-1 ghosts behind an object by a reflector that is not known
  double type1_per_object = 0.8;  ///< expected detections by one reflector
  double type1_unheard = 0.0;     ///< weight of those of tracks that were not detected directly, though they could be
  double type2_per_object = 4.0;
  double real_per_object = 3.0;
  double real_per_truck = 9.0;  ///< of what is longer than a car, by its track; beyond 8 m as many more as it is longer
  double tentative_weight = 0.1;  ///< of an object whose track is not confirmed yet
  double wheel_share = 0.5;       ///< of an object's detections that are of wheels or limbs, at other range rates
  double strength_doubt = 0.02;   ///< share of cases in which a detection's strength tells nothing
  double stationary_image_density = 2e-5;  ///< images of the stationary world: for each m², at the range rate they have
  double extent_std_m = 1.3;               ///< of a reflection from another place of the same object
  double range_rate_slack_mps = 0.3;       ///< turning, bodies that are not rigid
  double margin_m = 1.0;                   ///< a ghost of an unknown path lies at least this far behind its object
  double min_mirror_length_m = 5.0;        ///< of a vehicle whose sides are mirrors
  double mirror_doubt = 1.0;               ///< how much it counts whether reflectors are known to mirror; 0: all do
  double ego_front_m = 4.0, ego_rear_m = -1.0, ego_half_width_m = 0.95;  ///< the own body, seen in mirrors
};

}  // namespace boresight::ghosts
