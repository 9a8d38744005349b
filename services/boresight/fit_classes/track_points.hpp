// Which detections of a scan are a track's, for trackers that state tracks only.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/classes/class_evidence.hpp"
#include "services/tracker/core/classes/radar_levels.hpp"

namespace boresight::fit_classes {

/// The moving detections of a scan, in vehicle axes.
[[nodiscard]] std::vector<tracking::ClusterPoint> moving_points(const ClassifiedScan& scan, std::size_t radar,
                                                                const tracking::RadarLevels& levels);

/// Of each entry of the list, the points that are its own: each point belongs to the nearest box within a gate of
/// place and range rate.
[[nodiscard]] std::vector<std::vector<tracking::ClusterPoint>> points_of_tracks(
    std::span<const tracking::ClusterPoint> points, const TrackList& list);

/// A track in the scan, without its points.
[[nodiscard]] tracking::TrackObservation observation_of(const Track& track, const ClassifiedScan& scan,
                                                        const RadarConfig& radar);

}  // namespace boresight::fit_classes
