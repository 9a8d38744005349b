// The stationary detections of the recent past in a frame that does not move, by tiles of the plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::ghosts {

class StationaryTiles {
 public:
  static constexpr double kTile_m = 24.0;
  static constexpr std::int32_t kAcross =
      16;  ///< tiles in each direction; tiles this many apart share memory, and the latest one keeps it
  static constexpr std::size_t kMostPoints = 256;  ///< of a tile; the oldest give way
  static constexpr std::size_t kTiles = std::size_t{kAcross} * kAcross;

  struct Tile {
    geometry::GridCell place{};
    std::uint32_t added = 0;  ///< points since the tile has this place
    std::int64_t newest_ns = std::numeric_limits<std::int64_t>::min();
    [[nodiscard]] Eigen::Vector2d low_m() const { return {kTile_m * place.column, kTile_m * place.row}; }
  };

  StationaryTiles();
  void clear();
  /// Returns the number of the tile. Not finite: ignored, and kTiles is returned.
  std::size_t add(const Eigen::Vector2d& position_m, std::int64_t time_ns);
  [[nodiscard]] std::span<const Tile> tiles() const { return tiles_; }
  [[nodiscard]] static std::size_t number_of(geometry::GridCell place);
  /// Appends the points of a tile since `oldest_ns` that lie from `low_m` to `high_m`.
  void collect(std::size_t number, std::int64_t oldest_ns, const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m,
               std::vector<Eigen::Vector2d>& points) const;
  /// The same of all tiles, wherever the points lie.
  void collect(std::int64_t oldest_ns, std::vector<Eigen::Vector2d>& points) const;
  /// Points in memory.
  [[nodiscard]] std::size_t size() const;

 private:
  struct Point {
    float x_m, y_m;  // from the tile's corner
    std::int64_t time_ns;
  };
  std::vector<Tile> tiles_;
  std::vector<Point> points_;  // kMostPoints of each tile, as rings
};

}  // namespace boresight::ghosts
