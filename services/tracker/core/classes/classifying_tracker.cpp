#include "services/tracker/core/classes/classifying_tracker.hpp"

#include <utility>

#include "services/tracker/core/output/published_class.hpp"

namespace boresight::tracking {

ClassifyingTracker::ClassifyingTracker(std::unique_ptr<MultiObjectTracker> tracker, TrackEvidence evidence)
    : tracker_(std::move(tracker)), evidence_(std::move(evidence)), list_(std::make_unique<TrackList>()) {}

StepResult ClassifyingTracker::step(const ClassifiedScan& scan) {
  const StepResult result = tracker_->step(scan);
  tracker_->write(*list_);
  evidence_.step(scan, *list_);
  return result;
}

void ClassifyingTracker::write(TrackList& out) const {
  tracker_->write(out);
  for (std::size_t k = 0; k < out.number_of_tracks; ++k) {
    Track& track = out.tracks[k];
    const ClassEvidence* const evidence = evidence_.find(track.tracking_id);
    if (evidence == nullptr) continue;
    publish_class(evidence_.classifier().probabilities(*evidence), track);
  }
}

}  // namespace boresight::tracking
