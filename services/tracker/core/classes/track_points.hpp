// Which detections of a scan are a track's, for trackers that state tracks only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/classes/class_evidence.hpp"
#include "services/tracker/core/classes/radar_levels.hpp"

namespace boresight::tracking {

/// The moving detections of a scan by their tracks, in vehicle axes. Does not allocate after construction.
class TrackPoints {
 public:
  explicit TrackPoints(const ClassEvidenceParameters& parameters);

  /// Each moving detection belongs to the nearest box within a gate of place and range rate, or to none.
  void find(const ClassifiedScan& scan, std::size_t radar, const RadarLevels& levels, const TrackList& list);
  /// Of an entry of the list.
  [[nodiscard]] std::span<const ClusterPoint> of(std::size_t track) const {
    return std::span(by_track_).subspan(begin_[track], begin_[track + 1] - begin_[track]);
  }

 private:
  void read(const ClassifiedScan& scan, std::size_t radar, const RadarLevels& levels);
  /// Distance of a point from the box of a track; infinite beyond the gate.
  [[nodiscard]] double gated_distance_m(const ClusterPoint& point, const Track& track) const;

  ClassEvidenceParameters parameters_;
  std::vector<ClusterPoint> points_, by_track_;
  std::vector<std::uint32_t> owner_;  // of points_: index of a track, or their number
  std::vector<std::size_t> begin_;    // of each track in by_track_, and the end
};

/// A track in the scan of a radar, without its points and times.
[[nodiscard]] TrackObservation observation_of(const Track& track, const ClassifiedScan& scan, const RadarConfig& radar);

}  // namespace boresight::tracking
