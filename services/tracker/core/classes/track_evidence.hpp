// Evidence for the class of each track of a list, from scan to scan.
#pragma once

#include <cstdint>
#include <vector>

#include "services/tracker/core/classes/track_classifier.hpp"
#include "services/tracker/core/classes/track_points.hpp"
#include "services/tracker/core/fixed_table.hpp"

namespace boresight::tracking {

class TrackEvidence {
 public:
  /// Throws std::invalid_argument as DecisionForest does.
  TrackEvidence(const VehicleConfig& vehicle, const ObjectForest& forest);

  /// Adds a scan with the tracks after it; tracks that are not in the list are forgotten. Does not allocate.
  void step(const ClassifiedScan& scan, const TrackList& list);
  /// Of a track of the latest list; null for another.
  [[nodiscard]] const ClassEvidence* find(std::uint32_t tracking_id) const;
  [[nodiscard]] const TrackClassifier& classifier() const { return classifier_; }

 private:
  struct Record {
    std::uint32_t id = 0;
    ClassEvidence evidence;
  };

  VehicleConfig vehicle_;
  TrackClassifier classifier_;
  TrackPoints points_;
  std::vector<Record> records_, before_;
  FixedTable index_;  // of records_ by id
  std::int64_t time_ns_ = 0;
  bool has_time_ = false;
  double yaw_rad_ = 0.0;  // of the vehicle since the first scan
};

}  // namespace boresight::tracking
