// Any tracker, with the surroundings of the vehicle.
#pragma once

#include <memory>

#include "services/tracker/core/multi_object_tracker.hpp"
#include "services/tracker/core/surroundings/surroundings.hpp"

namespace boresight::tracking {

class SurroundingsTracker final : public MultiObjectTracker {
 public:
  SurroundingsTracker(std::unique_ptr<MultiObjectTracker> tracker, Surroundings surroundings);

  StepResult step(const ClassifiedScan& scan) override;
  void write(TrackList& out) const override;

 private:
  std::unique_ptr<MultiObjectTracker> tracker_;
  Surroundings surroundings_;
  std::unique_ptr<TrackList> list_;  // of the latest step: the surroundings read its tracks
};

}  // namespace boresight::tracking
