// Any tracker, with the classes of its tracks by the decision forest.
#pragma once

#include <memory>

#include "services/tracker/core/classes/track_evidence.hpp"
#include "services/tracker/core/multi_object_tracker.hpp"

namespace boresight::tracking {

class ClassifyingTracker final : public MultiObjectTracker {
 public:
  ClassifyingTracker(std::unique_ptr<MultiObjectTracker> tracker, TrackEvidence evidence);

  StepResult step(const ClassifiedScan& scan) override;
  void write(TrackList& out) const override;

 private:
  std::unique_ptr<MultiObjectTracker> tracker_;
  TrackEvidence evidence_;
  std::unique_ptr<TrackList> list_;  // of the latest step
};

}  // namespace boresight::tracking
