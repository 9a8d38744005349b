#include "tests/closed_loop/figures.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "services/common/geometry/frames.hpp"

namespace boresight::closed_loop {

namespace {

Eigen::Vector2d position_of(const Track& track) {
  return {track.position_vehicle_m[0], track.position_vehicle_m[1]};
}

}  // namespace

void Judge::end_stay(Stay& stay, double t_s) {
  if (stay.since_s >= 0.0 && t_s - stay.since_s > 3.0) {
    ++figures_.stays;
    figures_.stays_found += stay.found_s >= 0.0 ? 1 : 0;
    if (stay.found_s >= 0.0) figures_.worst_delay_s = std::max(figures_.worst_delay_s, stay.found_s - stay.since_s);
  }
  stay = {};
}

void Judge::judge_tracks(double t_s, const TrackList& tracks, const std::vector<Object>& objects) {
  std::set<std::uint32_t> taken;
  for (std::size_t k = 0; k < tracks.number_of_confirmed_tracks; ++k) {
    const Track& track = tracks.tracks[k];
    Life& life = lives_.try_emplace(track.tracking_id, Life{t_s}).first->second;
    ++life.scans;
    const auto distance = [&](const Object& o) { return o.distance_m(position_of(track)); };
    const auto nearest = std::min_element(objects.begin(), objects.end(),
                                          [&](const Object& a, const Object& b) { return distance(a) < distance(b); });
    if (nearest != objects.end() && distance(*nearest) < kMaxTrackDistance_m) {
      figures_.twice += taken.insert(nearest->id).second ? 0 : 1;
      continue;
    }
    ++life.false_scans;
    ++(life.born_s < kAligned_s ? figures_.early_false_scans : figures_.false_scans);
  }
}

void Judge::judge_object(double t_s, const Object& object, const TrackList& tracks) {
  Stay& stay = stays_[object.id];
  if (object.position_m.norm() > kFarthest_m || t_s - stay.seen_s > kHidden_s) {
    const double seen_s = stay.seen_s;
    end_stay(stay, t_s);
    stay.seen_s = seen_s;
    return;
  }
  if (stay.since_s < 0.0) stay.since_s = t_s;
  const Track* best = nullptr;
  for (std::size_t k = 0; k < tracks.number_of_confirmed_tracks; ++k) {
    const Track& track = tracks.tracks[k];
    if (object.distance_m(position_of(track)) > kMaxTrackDistance_m) continue;
    const auto distance = [&](const Track& t) { return (position_of(t) - object.position_m).norm(); };
    if (best == nullptr || distance(track) < distance(*best)) best = &track;
  }
  if (best != nullptr && stay.found_s < 0.0) stay.found_s = t_s;
  if (t_s - stay.since_s < 1.5) return;
  ++figures_.chances;
  if (best == nullptr) return;
  ++figures_.found;
  const Eigen::Vector2d error = position_of(*best) - object.position_m;
  const Eigen::Vector2d forward(std::cos(object.heading_rad), std::sin(object.heading_rad)),
      left(-forward.y(), forward.x());
  const Eigen::Vector2d velocity(best->velocity_over_ground_mps[0], best->velocity_over_ground_mps[1]);
  const double turned = geometry::wrap_angle(static_cast<double>(best->heading_rad) - object.heading_rad);
  figures_.along_rms_m += std::pow(forward.dot(error), 2);
  figures_.across_rms_m += std::pow(left.dot(error), 2);
  figures_.velocity_rms_mps += (velocity - object.velocity_mps).squaredNorm();
  figures_.heading_rms_rad += turned * turned;
  figures_.length_bias_m += static_cast<double>(best->length_m) - object.length_m;
  figures_.width_bias_m += static_cast<double>(best->width_m) - object.width_m;
  if (stay.track != 0 && stay.track != best->tracking_id) ++figures_.switches;
  stay.track = best->tracking_id;
}

void Judge::add(double t_s, const Chain& chain, const std::vector<simulator::DetectionTruth>& truth,
                const std::vector<Object>& objects) {
  ++figures_.scans;
  for (const simulator::DetectionTruth& detection : truth) {
    if (detection.provenance == Provenance::kMoving) stays_[detection.object_id].seen_s = t_s;
  }
  judge_tracks(t_s, *chain.tracks, objects);
  for (const Object& object : objects) judge_object(t_s, object, *chain.tracks);
}

Figures Judge::finish(double t_s) {
  for (auto& [id, stay] : stays_) end_stay(stay, t_s);
  figures_.ids = lives_.size();
  for (const auto& [id, life] : lives_) {
    if (2 * life.false_scans <= life.scans) continue;
    ++(life.born_s < kAligned_s ? figures_.early_false_ids : figures_.false_ids);
  }
  const double found = static_cast<double>(figures_.found);
  for (double* sum :
       {&figures_.along_rms_m, &figures_.across_rms_m, &figures_.velocity_rms_mps, &figures_.heading_rms_rad}) {
    *sum = std::sqrt(*sum / found);
  }
  figures_.length_bias_m /= found;
  figures_.width_bias_m /= found;
  return figures_;
}

}  // namespace boresight::closed_loop
