#include "tests/benchmarks/ghosts/common/lost_objects.hpp"

#include <algorithm>
#include <functional>

namespace boresight::bench {

void TrackedObjects::add(const Matching& matching, const std::vector<closed_loop::Object>& objects) {
  for (std::size_t o = 0; o < objects.size(); ++o) {
    Second& second = seconds_[objects[o].id];
    if (objects[o].is_hidden) {
      ++second.hidden;
      continue;
    }
    ++second.scans;
    second.tracked += matching.track_of_object[o] != kNone ? 1 : 0;
  }
}

void TrackedObjects::add_detections(const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth) {
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, truth.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Provenance is = truth[i].provenance;
    const bool is_direct = is == Provenance::kMoving || is == Provenance::kStationary;
    const auto second = is_direct && scan.provenance[i] == is ? seconds_.find(truth[i].object_id) : seconds_.end();
    if (second != seconds_.end()) ++second->second.detections;
  }
}

void LostObjects::add_second(double until_s, const TrackedObjects& with_perfect_labels,
                             const TrackedObjects& with_filter) {
  for (const auto& [id, second] : with_perfect_labels.seconds()) {
    if (second.detections == 0 || !second.is_long_in_sight()) continue;
    const TrackedObjects::Second& filtered = with_filter.seconds().at(id);
    const double with_labels = filtered.share();
    if (second.share() < kLostShare && with_labels >= kHeldShare) ++gained;
    if (second.share() < kHeldShare) continue;
    ++object_seconds;
    ++of_object[id].held;
    if (with_labels >= kLostShare) continue;
    ++of_object[id].lost;
    lost.push_back({until_s, id});
    const auto own = static_cast<double>(second.detections);
    lost_though_correct += static_cast<double>(filtered.detections) >= kMinCorrectShare * own ? 1 : 0;
  }
}

std::size_t LostObjects::mostly_lost() const {
  const auto is_lost = [](const auto& object) { return 2 * object.second.lost > object.second.held; };
  return static_cast<std::size_t>(std::count_if(of_object.begin(), of_object.end(), is_lost));
}

LostByChance& LostByChance::operator+=(const LostByChance& other) {
  std::transform(seconds.begin(), seconds.end(), other.seconds.begin(), seconds.begin(), std::plus<>());
  return *this;
}

std::size_t LostByChance::least() const {
  return *std::min_element(seconds.begin(), seconds.end());
}

std::size_t LostByChance::most() const {
  return *std::max_element(seconds.begin(), seconds.end());
}

}  // namespace boresight::bench
