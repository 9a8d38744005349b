// Settings of the map of reflectors; the defaults are what config/services/ghost_filter.toml ships.
#pragma once

#include <cstddef>

namespace boresight::ghosts {

struct LineConfig {
  double cell_m = 0.5;        ///< the detections of each cell of such a grid are replaced by their mean
  std::size_t draws = 32;     ///< pairs of cells that are tried for one line
  double tolerance_m = 0.5;   ///< a cell this near to a line lies on it
  double max_gap_m = 5.0;     ///< without a cell; farther on it is another reflector
  std::size_t min_cells = 6;  ///< of a reflector
  double min_length_m = 5.0;
  double beside_m = 1.2;       ///< cells this near to the line that do not lie on it speak against it
  double min_purity = 0.6;     ///< share of the cells within `beside_m` that lie on the line
  std::size_t most_lines = 6;  ///< of one tile
};

struct MapConfig {
  double memory_s = 1.0;           ///< of stationary detections
  double search_period_s = 0.25;   ///< each tile of the plane is searched this often
  double least_new_share = 0.125;  ///< of a tile's detections; with fewer new ones it is not searched again
  double most_std_m = 0.5;         ///< of a detection's position, across the line of sight
  std::size_t most_points = 512;   ///< searched in one scan; a tile that was begun is completed
  LineConfig lines;
};

}  // namespace boresight::ghosts
