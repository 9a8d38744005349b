// Settings of the search for reflectors among stationary detections.
#pragma once

#include <cstddef>

namespace boresight::ghosts {

struct SegmentConfig {
  double cell_m = 0.5;                 ///< the points of each cell of such a grid are replaced by their mean
  double cluster_length_m = 3.0;       ///< DBSCAN's reach along the first axis of the points' frame
  double cluster_width_m = 3.0;        ///< and along the second
  std::size_t cluster_min_points = 3;  ///< cells
  double min_segment_length_m = 5.0;
  std::size_t min_segment_points = 6;   ///< cells
  double max_segment_residual_m = 0.3;  ///< rms distance from the line
};

struct MapConfig {
  double memory_s = 1.0;          ///< of stationary detections
  double search_period_s = 0.5;   ///< each tile of the plane is searched this often
  double most_std_m = 0.5;        ///< of a detection's position, across the line of sight
  std::size_t most_points = 512;  ///< searched in one scan, but for the last tile
  SegmentConfig segments;
};

}  // namespace boresight::ghosts
