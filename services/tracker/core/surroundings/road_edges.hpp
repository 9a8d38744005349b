// Road edges, tracked over scans. Equations (W3)…(W8).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interfaces/messages/track_list.hpp"
#include "services/tracker/core/surroundings/edge_line.hpp"
#include "services/tracker/core/surroundings/edge_search.hpp"

namespace boresight::tracking {

/// Where a place lies if the vehicle follows the road: the difference of both distances to an edge, + left.
struct RoadCourse {
  bool is_known = false;
  double aside_m = 0.0;
  double variance_m2 = 0.0;
};

class RoadEdges {
 public:
  /// Edges are counted from `behind_m` behind the vehicle on.
  RoadEdges(const RoadEdgeParameters& parameters, double behind_m);

  void clear();
  /// Moves the edges with the vehicle, then takes the scan. `elapsed_s` may be negative.
  void step(const StationaryMemory& memory, const EgoPath& path, const geometry::EgoStep& step, double yaw_rad,
            double elapsed_s);
  void write(TrackList& out) const;
  /// By the edge that is known best at the place; unknown if none reaches so far.
  [[nodiscard]] RoadCourse course(const Eigen::Vector2d& place_m) const;

 private:
  static constexpr std::size_t kCells = 32;  // more than ahead_m and the part behind have

  /// Decayed numbers of detections of one segment of the line: on it, and in the bands beside it.
  struct Cell {
    std::int64_t place = -1;  ///< number of the segment by the way driven
    double on = 0.0, inner = 0.0, outer = 0.0;
  };
  struct Edge {
    std::uint32_t id = 0;  ///< 0: none
    double side = 1.0;
    EdgeLine line;
    EdgeDensities densities;
    double scatter_m2 = 0.0, scatter_weight = 0.0;
    double age_s = 0.0, since_update_s = 0.0;
    double log_odds = 0.0;
    double start_m = 0.0, end_m = 0.0;
    double detections = 0.0;
    bool is_seen = false;
    std::array<Cell, kCells> cells;
  };
  void update(Edge& edge, const StationaryMemory& memory, double elapsed_s);
  void count(Edge& edge, const StationaryMemory& memory, double elapsed_s);
  void judge(Edge& edge);
  void start(const StationaryMemory& memory, const EgoPath& path);
  [[nodiscard]] bool is_alive(const Edge& edge) const;
  void drop_doubles();

  RoadEdgeParameters parameters_;
  double behind_m_;
  ContrastVote vote_;
  EdgeSearch search_;
  std::array<Edge, kMaxRoadEdges> edges_{};
  double driven_m_ = 0.0;
  std::uint32_t next_id_ = 1;
  std::uint32_t turn_ = 0;  // of the search among sides and curvatures
};

}  // namespace boresight::tracking
