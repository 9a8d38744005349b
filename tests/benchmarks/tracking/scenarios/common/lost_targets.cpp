#include "tests/benchmarks/tracking/scenarios/common/lost_targets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "services/simulator/judge/gospa.hpp"
#include "services/simulator/judge/pairing.hpp"

namespace boresight::bench::scenarios {

namespace {

struct Life {
  bool found = false;
  std::size_t gap = 0, longest_gap = 0;  // scans
};

}  // namespace

LostTargets count_lost_targets(const track::ObjectsByStep& truth, const track::ObjectsByStep& estimates) {
  const std::vector<track::ExtendedObject> none;
  std::map<std::uint32_t, Life> lives;
  judge::Pairing pairing;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& objects = truth[i];
    const auto& estimated = i < estimates.size() ? estimates[i] : none;
    std::vector<judge::PairCost> pairs;
    for (std::size_t o = 0; o < objects.size(); ++o) {
      for (std::size_t e = 0; e < estimated.size(); ++e) {
        const double distance_m =
            std::sqrt(judge::gaussian_wasserstein_squared(objects[o].ellipse, estimated[e].ellipse));
        if (distance_m < judge::Gospa::kCutOff) pairs.push_back({o, e, distance_m});
      }
    }
    pairing.solve(objects.size(), estimated.size(), pairs, judge::Gospa::kCutOff);
    for (std::size_t o = 0; o < objects.size(); ++o) {
      Life& life = lives[objects[o].id];
      const bool has_estimate = pairing.column_of(o) != judge::Pairing::kNoPartner;
      life.found = life.found || has_estimate;
      life.gap = has_estimate || !life.found ? 0 : life.gap + 1;
      life.longest_gap = std::max(life.longest_gap, life.gap);
    }
  }
  LostTargets result;
  for (const auto& [id, life] : lives) {
    ++result.targets;
    result.found += life.found ? 1 : 0;
    result.lost += life.longest_gap > LostTargets::kLongestGap ? 1 : 0;
  }
  return result;
}

}  // namespace boresight::bench::scenarios
