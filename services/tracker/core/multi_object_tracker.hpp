// The one interface of all trackers: a classified scan in, a track list out.
#pragma once

#include <cstdint>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"

namespace boresight::tracking {

/// Findings of one step beside the tracks.
struct StepResult {
  bool out_of_order = false;                 ///< older than the scan before: used at its own time
  bool restarted = false;                    ///< the clock jumped: all tracks were dropped
  bool budget_reached = false;               ///< the search for associations stopped at its work budget
  std::uint32_t dropped_detections = 0;      ///< detections beyond a capacity
  std::uint32_t dropped_objects = 0;         ///< objects and hypotheses of objects beyond a capacity
  std::uint32_t cut_gates = 0;               ///< groups were kept apart that share detections: a simpler association
  std::uint32_t likelihood_evaluations = 0;  ///< work of the step
};

class MultiObjectTracker {
 public:
  virtual ~MultiObjectTracker() = default;

  /// Takes one scan, of any radar, at its own measurement time. Does not allocate.
  virtual StepResult step(const ClassifiedScan& scan) = 0;

  /// Writes everything but the header: likeliest objects first, tentative ones too.
  virtual void write(TrackList& out) const = 0;
};

}  // namespace boresight::tracking
