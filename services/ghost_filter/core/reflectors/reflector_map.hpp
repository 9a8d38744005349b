// Reflectors (rails, walls): line segments of the stationary world, searched tile by tile.
//
// The search is spread over the scans: each of them searches the tiles that are due.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/ghost_filter/core/odometry.hpp"
#include "services/ghost_filter/core/reflectors/config.hpp"
#include "services/ghost_filter/core/reflectors/line_search.hpp"
#include "services/ghost_filter/core/reflectors/stationary_tiles.hpp"

namespace boresight::ghosts {

class ReflectorMap {
 public:
  explicit ReflectorMap(const MapConfig& config);

  void clear();
  /// A stationary detection in the odometry frame, with the standard deviation of its position. Detections that are
  /// not finite, or too uncertain, are ignored.
  void add(const Eigen::Vector2d& position_m, double std_m, std::int64_t time_ns);
  /// After the detections of a scan: searches the tiles that are due, forgets what is old.
  void update(std::int64_t time_ns);

  /// In the odometry frame.
  [[nodiscard]] std::span<const Segment> reflectors() const { return reflectors_; }
  [[nodiscard]] std::size_t points() const { return tiles_.size(); }

 private:
  struct Found {
    geometry::GridCell place{};
    std::uint32_t added = 0;  // points of the tile at the search
    std::vector<Segment> segments;
    void begin(geometry::GridCell at) {
      place = at;
      added = 0;
      segments.clear();
    }
  };
  /// Searches one tile; returns the number of points.
  std::size_t search(std::size_t number, std::int64_t oldest_ns);
  [[nodiscard]] double with_continuations_m(const Segment& segment, geometry::GridCell place) const;
  MapConfig config_;
  StationaryTiles tiles_;
  LineSearch lines_;
  std::vector<Found> found_;  // by tile
  std::vector<Segment> reflectors_;
  std::vector<Eigen::Vector2d> points_;
  std::size_t next_ = 0;
  std::int64_t updated_ns_ = 0;
};

/// As the classified scan publishes them, from the odometry frame.
void write_segments(std::span<const Segment> segments, const Odometry& odometry, ClassifiedScan& out);

}  // namespace boresight::ghosts
