#include "services/tracker/core/surroundings/surroundings_tracker.hpp"

#include <algorithm>
#include <utility>

namespace boresight::tracking {

SurroundingsTracker::SurroundingsTracker(std::unique_ptr<MultiObjectTracker> tracker, Surroundings surroundings)
    : tracker_(std::move(tracker)), surroundings_(std::move(surroundings)), list_(std::make_unique<TrackList>()) {
  tracker_->write(*list_);
}

StepResult SurroundingsTracker::step(const ClassifiedScan& scan) {
  const StepResult result = tracker_->step(scan);
  tracker_->write(*list_);
  surroundings_.step(scan, *list_);
  return result;
}

void SurroundingsTracker::write(TrackList& out) const {
  out.number_of_tracks = list_->number_of_tracks;
  out.number_of_confirmed_tracks = list_->number_of_confirmed_tracks;
  out.flags = list_->flags;
  out.dropped_tracks = list_->dropped_tracks;
  out.tracker_flags = list_->tracker_flags;
  out.likelihood_evaluations = list_->likelihood_evaluations;
  const std::size_t tracks = std::min<std::size_t>(list_->number_of_tracks, kMaxTracks);
  std::copy_n(list_->tracks.begin(), tracks, out.tracks.begin());
  surroundings_.write(out);
}

}  // namespace boresight::tracking
