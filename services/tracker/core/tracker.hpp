// Tracks of moving objects from classified scans: predict, assign, update, confirm, delete.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/geometry/assignment.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/clusters.hpp"
#include "services/tracker/core/multi_object_tracker.hpp"
#include "services/tracker/core/own_road.hpp"
#include "services/tracker/core/rules_config.hpp"
#include "services/tracker/core/tracked_object.hpp"

namespace boresight::tracking {

/// The rule-based tracker.
class Tracker final : public MultiObjectTracker {
 public:
  Tracker(const VehicleConfig& vehicle, const RulesConfig& config);

  /// Takes one scan, of any radar, at its own measurement time.
  StepResult step(const ClassifiedScan& scan) override;

  /// Writes everything but the header; confirmed tracks first, by id.
  void write(TrackList& out) const override;

 private:
  void predict_all(double elapsed_s, const ScanGeometry& geometry);
  /// Where confirmed people and cycles are, and vehicles that are not new.
  std::span<const KnownPlace> known();
  std::span<const Cluster> join_parts(std::span<const Cluster> clusters);
  void assign(std::span<const Cluster> clusters, const Eigen::Vector2d& sensor, bool has_elevation);
  /// Place and velocity of a track by the cluster that is its own; false: that tells nothing.
  [[nodiscard]] bool follow(TrackedObject& track, const Cluster& cluster, const Eigen::Vector2d& sensor) const;
  /// Heading and size of a track that the cluster has just updated.
  void update_extent(TrackedObject& track, const Cluster& cluster, const Eigen::Vector2d& sensor,
                     bool has_elevation) const;
  /// Nothing is where the own vehicle is: moves tracks that drift there back beside it, their velocity, too.
  void push_off(double ego_speed_mps);
  void start_track(const Cluster& cluster, const Eigen::Vector2d& sensor, bool has_elevation);
  /// Of each track, what the scan says of whether it is there; gives up those that are not.
  void judge(const ClassifiedScan& scan);

  VehicleConfig vehicle_;
  RulesConfig config_;
  Clusterer clusterer_;
  geometry::Assignment assignment_;
  std::vector<TrackedObject> tracks_;
  std::array<bool, geometry::Assignment::kCapacity> cluster_used_{};
  std::array<KnownPlace, kMaxTracks> known_;
  OwnRoad road_;                                                        // at the time of the last scan
  Eigen::Vector2d radars_low_m_{1e9, 1e9}, radars_high_m_{-1e9, -1e9};  // what lies between them is the own body
  std::uint32_t next_id_ = 1;
  std::int64_t time_ns_ = 0;
  std::uint32_t flags_ = 0;
  std::uint32_t dropped_tracks_ = 0;
};

}  // namespace boresight::tracking
