// The stationary detections of the recent past of all radars, one mean for each cell of a grid that stands still. Cells
// hang together by tiles of the plane, so that what is done about them can be done tile by tile, over many scans.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"

namespace boresight::ghosts {

class StationaryGrid {
 public:
  static constexpr std::uint32_t kUnclaimed = std::numeric_limits<std::uint32_t>::max();  ///< no cell
  static constexpr std::int32_t kTileCells = 32;                                          ///< across a tile
  struct Cell {
    Eigen::Vector2d sum_m{0.0, 0.0};
    std::int64_t first_ns = 0;  ///< since when something was detected here again and again
    std::uint32_t count = 0;    ///< 0: not in use
    [[nodiscard]] Eigen::Vector2d mean_m() const { return sum_m / count; }
  };
  struct Tile {
    geometry::GridCell place{};
    std::uint32_t first = kUnclaimed;  ///< cell
    std::uint32_t cells = 0;
    std::uint32_t news = 0;  ///< cells that were begun, or became exact, since the tile was searched
  };

  /// Room for `capacity` cells; points in further ones are dropped until the oldest are forgotten.
  StationaryGrid(std::size_t capacity, double cell_m);

  void clear();
  /// A detection that looks stationary; not finite: ignored. `index` is what index_at() told of it, if that was asked
  /// for. Returns what it tells now.
  std::uint32_t add(const Eigen::Vector2d& position_m, std::int64_t time_ns, bool claimed, bool exact,
                    std::uint32_t index = kUnclaimed);
  /// Of the tile with that number, forgets the cells last hit before `oldest_ns`. If nothing is left the tile goes,
  /// too: the last one has its number then, and false is returned.
  bool forget(std::size_t tile, std::int64_t oldest_ns);

  [[nodiscard]] double cell_m() const { return cell_m_; }
  [[nodiscard]] std::size_t size() const { return cells_.size() - unused_.size(); }
  /// With those not in use.
  [[nodiscard]] std::span<const Cell> cells() const { return cells_; }
  [[nodiscard]] std::span<Tile> tiles() { return tiles_; }
  /// Calls `visit(mean_m, exact)` for the cells of the tile at a place, if there is one, from `low` to `high` that no
  /// reflector claims; exact: the mean is of where detections are known well.
  template <typename Visit>
  void visit_unclaimed(geometry::GridCell tile_place, geometry::GridCell low, geometry::GridCell high,
                       const Visit& visit) const {
    const std::uint32_t* const tile = tile_table_.find(tile_place);
    for (std::uint32_t i = tile == nullptr ? kUnclaimed : tiles_[*tile].first; i != kUnclaimed; i = links_[i].next) {
      const Link& link = links_[i];
      if (link.claimed || link.place.column < low.column || link.place.row < low.row ||
          link.place.column > high.column || link.place.row > high.row)
        continue;
      visit(cells_[i].mean_m(), link.exact);
    }
  }
  /// Index of the cell at a position, or kUnclaimed.
  [[nodiscard]] std::uint32_t index_at(const Eigen::Vector2d& position_m) const;
  /// The same for one that is needed soon, which is fetched from memory meanwhile: the map is larger than the cache.
  [[nodiscard]] std::uint32_t fetch_at(const Eigen::Vector2d& position_m) const {
    const std::uint32_t index = index_at(position_m);
    if (index == kUnclaimed) return index;
    __builtin_prefetch(&cells_[index], 1);
    __builtin_prefetch(&links_[index], 1);
    return index;
  }
  /// Says of the cell at a position that it belongs to a reflector.
  void claim(const Eigen::Vector2d& position_m);

 private:
  /// What is asked of all cells of a tile, apart from the rest: of a large map that stays in the cache.
  struct Link {
    geometry::GridCell place{};
    std::int64_t last_ns = 0;  ///< when something was detected here
    std::uint32_t next = kUnclaimed;
    bool claimed = false;  ///< the cell's last detection belongs to a known reflector
    bool exact = false;
  };
  double cell_m_;
  geometry::CellTable table_, tile_table_;
  std::vector<Cell> cells_;
  std::vector<Link> links_;  // of each cell
  std::vector<std::uint32_t> unused_;
  std::vector<Tile> tiles_;
};

}  // namespace boresight::ghosts
