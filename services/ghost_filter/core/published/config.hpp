// Settings of the published method, [published] of config/services/ghost_filter.toml.
#pragma once

#include <cstddef>

namespace boresight::ghosts::published {

struct Config {
  double memory_s = 0.4;          ///< stationary detections of this time make the reflectors
  double update_period_s = 0.05;  ///< they are found anew this often, and moved with the ego motion in between
  double cell_m = 1.0;            ///< and of each cell of such a grid only the mean
  double cluster_radius_m = 3.0;
  std::size_t cluster_min_points = 3;  ///< cells
  double min_segment_length_m = 4.0;
  std::size_t min_segment_points = 5;
  double max_segment_residual_m = 0.4;  ///< rms distance from the line; longer curves are split until they fit
  double type2_margin_m = 1.0;          ///< a ghost lies at least this far behind its reflector
  double type1_margin_m = 1.0;          ///< and this far behind its target
  double ellipse_margin_m = 0.5;        ///< added to the half axes of a track
  double tracks_max_age_s = 0.5;
};

}  // namespace boresight::ghosts::published
