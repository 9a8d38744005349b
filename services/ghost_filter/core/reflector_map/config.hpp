// Settings of the reflector map.
#pragma once

#include <cstddef>

namespace boresight::ghosts {

struct MapConfig {
  double memory_s = 1.0;         ///< a cell that was not hit for this long is forgotten
  double update_period_s = 0.2;  ///< each reflector is fitted to what is new this often
  double search_period_s = 0.5;  ///< new ones are looked for in each place this often
  double cell_m = 0.5;
  std::size_t capacity = 8192;    ///< cells
  double cluster_radius_m = 3.0;  ///< DBSCAN of the cells that no reflector claims
  std::size_t cluster_min_cells = 3;
  double tolerance_m = 0.3;   ///< RANSAC: a cell this near to the curve belongs to it
  std::size_t min_cells = 6;  ///< of a new reflector
  double min_length_m = 5.0;  ///< of a new reflector
  double max_gap_m = 5.0;     ///< without a cell; farther on it is another reflector
  double min_purity = 0.6;    ///< share of the cells within four tolerances that lie on the curve
  double max_curvature_per_m = 0.05;
  double bin_m = 2.0;  ///< along a reflector, for where it is there and where it is open
};

}  // namespace boresight::ghosts
