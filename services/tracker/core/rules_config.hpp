// Settings of the rule-based tracker.
#pragma once

#include <cstddef>

namespace boresight::tracking {

struct RulesConfig {
  double cluster_radius_m = 3.5;
  std::size_t cluster_min_points = 1;
  double cluster_max_range_rate_spread_mps = 4.0;  ///< a detection that moves otherwise belongs to another cluster
  double gate_chi2 = 16.0;            ///< Mahalanobis distance² of position and range rate (3 degrees of freedom)
  double jerk_std_mps3 = 3.0;         ///< process noise: how fast the acceleration changes
  double centre_std_m = 0.5;          ///< error of what the faces say of the middle, from scan to scan
  double range_rate_std_mps = 0.4;    ///< micro-motion and rotation, added to the sensor's std
  double start_position_std_m = 1.0;  ///< of the centre of a new object, of which only a part is seen
  double start_speed_std_mps = 7.0;
  double start_acceleration_std_mps2 = 2.0;
  double part_margin_m = 2.0;       ///< a cluster that close to a confirmed track's box is another part of that object
  double duplicate_margin_m = 1.0;  ///< of two tracks with one velocity, that close to the other's box, one is too many
  double duplicate_speed_mps = 5.0;
  std::size_t confirm_hits = 4;           ///< m …
  std::size_t confirm_window = 6;         ///< … of n scans that could see the object
  double confirm_evidence = 3.0;          ///< and as many of those hits are real, by what the ghost filter says of them
  double confirm_age_s = 0.15;            ///< and this long after the first: several radars at one instant are one look
  double confirm_image_age_s = 1.0;       ///< the same of what may be another track's image in an unknown mirror
  double confirm_side_image_age_s = 2.0;  ///< the same of what lies where a tracked vehicle's side would show it
  double confirm_weak_age_s = 4.0;        ///< the same of what is weaker than anything as fast: it rather is an image
  double start_realness = 0.2;            ///< what is less likely real starts no track
  std::size_t delete_misses = 8;          ///< k …
  std::size_t delete_window = 10;         ///< … of t scans
  double delete_age_s = 0.5;              ///< of a confirmed one, and so long after its last detection, as at birth
  double coast_s = 1.0;                   ///< longest prediction without a detection
  double blind_range_rate_mps = 1.5;      ///< below it over ground, a scan may take the object for stationary
  double stopped_speed_mps = 0.5;
};

}  // namespace boresight::tracking
