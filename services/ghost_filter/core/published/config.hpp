// Settings of the published method, [published] of config/services/ghost_filter.toml.
#pragma once

#include <cstddef>

namespace boresight::ghosts::published {

/// What the public example states from which Le Ba Thanh's scene comes (MathWorks, "Highway Vehicle Tracking with
/// Multipath Radar Reflections"): both thresholds of range rate, the clusters' ellipse and number, no margins. The
/// publication names the tests but not their constants.
struct Config {
  double max_range_rate_mps = 2.0;           ///< over ground: what is faster moves
  double min_expected_range_rate_mps = 2.0;  ///< standing things at right angles to the drive, where no speed shows,
                                             ///< are not told from moving ones and count as those
  double memory_s = 0.15;                    ///< stationary detections of this time make the reflectors
  double update_period_s = 0.05;             ///< found anew this often
  double cell_m = 0.5;                       ///< the points of each cell of such a grid are replaced by their mean
  double cluster_length_m = 8.0;             ///< DBSCAN's reach along the vehicle
  double cluster_width_m = 2.0;              ///< and across it
  std::size_t cluster_min_points = 8;        ///< cells
  double min_segment_length_m = 4.0;
  std::size_t min_segment_points = 5;
  double max_segment_residual_m = 0.8;  ///< rms distance from the line; longer curves are split until they fit
  double type2_margin_m = 0.0;          ///< a ghost lies at least this far behind its reflector
  double type1_margin_m = 0.0;          ///< and this far behind its target
  double ellipse_margin_m = 0.2;        ///< added to the half axes of a track
  double tracks_max_age_s = 0.5;
};

}  // namespace boresight::ghosts::published
