// The published method (Le Ba Thanh 2023), the baseline of all comparisons. A detection is stationary if its range rate
// over ground is below a constant threshold. A moving detection whose line of sight crosses a reflector segment is a
// type-2 ghost. Otherwise, if its line of sight passes through a predicted track, it is a type-1 ghost. The method does
// not check for an object at the mirrored position, has no clutter class, and takes a tracked object behind a rail for
// a ghost.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/geometry/segment.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/ghost_filter/core/odometry.hpp"
#include "services/ghost_filter/core/published/config.hpp"
#include "services/ghost_filter/core/published/segment_finder.hpp"
#include "services/ghost_filter/core/reflectors/stationary_tiles.hpp"

namespace boresight::ghosts::published {

class Filter final : public Method {
 public:
  explicit Filter(const Config& config);

  void add_tracks(const TrackList& tracks) override;
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return tiles_.size(); }

 private:
  [[nodiscard]] bool takes_part(const CorrectedScan& scan, std::size_t i) const;
  /// By a constant threshold, Le Ba Thanh 2023, (1)(2), whatever the corrector makes of the detection's uncertainty.
  [[nodiscard]] bool is_stationary(const CorrectedScan& scan, std::size_t i) const;
  /// Finds the segments anew when they are due.
  void update_segments(const CorrectedScan& scan, std::size_t count);
  void predict_tracks(const CorrectedScan& scan);
  [[nodiscard]] Provenance judge_moving(const Eigen::Vector2d& sensor, const Eigen::Vector2d& position) const;
  Config config_;
  Odometry odometry_;
  StationaryTiles tiles_;
  SegmentFinder finder_;
  std::vector<Eigen::Vector2d> points_;
  std::vector<Segment> segments_;  // in the odometry frame
  std::int64_t found_ns_ = 0;
  std::unique_ptr<TrackList> tracks_;  // a copy: the message leaves shared memory after the call
  bool has_tracks_ = false;
  std::array<geometry::Ellipse, kMaxTracks> ellipses_;
  std::size_t number_of_ellipses_ = 0;
};

}  // namespace boresight::ghosts::published
