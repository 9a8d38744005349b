#include "tests/benchmarks/ghosts/common/lost_objects.hpp"

namespace boresight::bench {

void TrackedObjects::add(const Matching& matching, const std::vector<closed_loop::Object>& objects) {
  for (std::size_t o = 0; o < objects.size(); ++o) {
    Second& second = seconds_[objects[o].id];
    ++second.scans;
    second.tracked += matching.track_of_object[o] != kNone ? 1 : 0;
  }
}

void LostObjects::add_second(double until_s, const TrackedObjects& with_perfect_labels,
                             const TrackedObjects& with_filter) {
  for (const auto& [id, second] : with_perfect_labels.seconds()) {
    if (second.share() < kHasIt) continue;
    ++object_seconds;
    if (with_filter.seconds().at(id).share() < kHasItNot) lost.push_back({until_s, id});
  }
}

}  // namespace boresight::bench
