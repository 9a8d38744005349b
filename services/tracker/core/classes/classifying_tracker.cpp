#include "services/tracker/core/classes/classifying_tracker.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace boresight::tracking {

namespace {

/// Of extended_object::RoadUserClass, in its order.
constexpr std::array kClasses = {ObjectClass::kPedestrian, ObjectClass::kTwoWheeler, ObjectClass::kCar,
                                 ObjectClass::kVan, ObjectClass::kTruck};

}  // namespace

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
    const ClassProbabilities p = evidence_.classifier().probabilities(*evidence);
    for (std::size_t c = 0; c < p.size(); ++c) {
      track.class_probability[static_cast<std::size_t>(kClasses[c])] = static_cast<float>(p[c]);
    }
    track.object_class = kClasses[static_cast<std::size_t>(std::max_element(p.begin(), p.end()) - p.begin())];
  }
}

}  // namespace boresight::tracking
