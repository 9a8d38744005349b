#include "services/tracker/core/classes/track_evidence.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace boresight::tracking {

TrackEvidence::TrackEvidence(const VehicleConfig& vehicle, const ObjectForest& forest)
    : vehicle_(vehicle),
      classifier_(forest, vehicle.radars.size()),
      points_(forest.evidence),
      index_(std::bit_ceil(2 * kMaxTracks + 2)) {
  records_.reserve(kMaxTracks);
  before_.reserve(kMaxTracks);
}

void TrackEvidence::step(const ClassifiedScan& scan, const TrackList& list) {
  const RadarConfig* const radar = vehicle_.radar(scan.header.source_id);
  if (radar == nullptr) return;
  const std::int64_t now_ns = scan.header.measurement_time_ns;
  // A scan that finished late adds no time.
  const double elapsed_s = has_time_ ? std::max(0.0, 1e-9 * static_cast<double>(now_ns - time_ns_)) : 0.0;
  time_ns_ = has_time_ ? std::max(time_ns_, now_ns) : now_ns;
  has_time_ = true;
  yaw_rad_ += static_cast<double>(scan.geometry.ego_yaw_rate_radps) * elapsed_s;
  const auto index = static_cast<std::size_t>(radar - vehicle_.radars.data());
  classifier_.levels().learn(scan, index);
  points_.find(scan, index, classifier_.levels(), list);
  std::swap(records_, before_);
  records_.clear();
  for (std::size_t k = 0; k < list.number_of_tracks; ++k) {
    const Track& track = list.tracks[k];
    Record record{track.tracking_id, {}};
    const int known = index_.find(track.tracking_id);
    if (known >= 0) record = before_[static_cast<std::size_t>(known)];
    TrackObservation observation = observation_of(track, scan, *radar);
    observation.points = points_.of(k);
    observation.elapsed_s = known >= 0 ? elapsed_s : 0.0;
    observation.yaw_rad = yaw_rad_;
    classifier_.add(record.evidence, observation);
    records_.push_back(record);
  }
  index_.clear();
  for (std::size_t k = 0; k < records_.size(); ++k) {
    static_cast<void>(index_.insert(records_[k].id, static_cast<int>(k)));
  }
}

const ClassEvidence* TrackEvidence::find(std::uint32_t tracking_id) const {
  const int known = index_.find(tracking_id);
  return known < 0 ? nullptr : &records_[static_cast<std::size_t>(known)].evidence;
}

}  // namespace boresight::tracking
