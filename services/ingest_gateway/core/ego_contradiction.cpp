#include "services/ingest_gateway/core/ego_contradiction.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

/// Below, range rates of stationary reflectors are too similar to those of slow traffic.
constexpr float kLeastSpeed_mps = 5.0F;
/// Highest speed in reverse. Without a signal of the direction of travel, the opposite sign may be true below it.
constexpr float kFastestReverse_mps = 10.0F;
/// Fewest detections and scans of a pool. The same object gives detections in many scans, so that they are not
/// independent; a truck passes within a second. Tracks live longer than detections.
constexpr std::size_t kLeastTested = 1500, kLeastTestedTracks = 3000, kLeastScans = 20;

/// Contradiction if another scale of speed (or the opposite speed) has this share of support, and this multiple of the
/// ego speed's support. Oncoming and preceding traffic also supports other speeds, but with a smaller share, or beside
/// more stationary reflectors.
constexpr double kOtherShare = 0.08, kOtherToEgo = 3.0;
/// Or if most detections support the opposite speed, by this share more than the ego speed. Folded into a narrow
/// unambiguous interval, both look alike if twice the speed is near a multiple of the interval.
constexpr double kOppositeShare = 0.5, kOppositeBeyondEgo = 0.10;
/// Or if the support exceeds that of randomly assigned range rates by less than this share …
constexpr double kBeyondChance = 0.10;
/// … provided that random assignment makes a difference, unlike for a radar that looks straight ahead …
constexpr double kMostAlike = 0.80;
/// … or if the share of stationary detections is below this in two pools in a row …
constexpr double kNothing = 0.03;
/// … provided that the radar reports more than a few tracks, which may all be moving objects for a long time.
constexpr std::size_t kDenseRadar = 20;

}  // namespace

bool EgoContradiction::judge(const RadarScan& scan, std::int64_t measurement_time_ns, const EgoMotion& ego) {
  if (!ego.has(ego_field::kSpeed | ego_field::kYawRate)) return false;
  EgoMotion then = ego;
  const double elapsed_s = static_cast<double>(measurement_time_ns - ego.header.measurement_time_ns) * 1e-9;
  if (std::abs(elapsed_s) < 1.0) {
    then.speed_mps += static_cast<float>(static_cast<double>(ego.longitudinal_acceleration_mps2) * elapsed_s);
  }
  const float speed_mps = std::abs(then.speed_mps);
  if (!(speed_mps > kLeastSpeed_mps && speed_mps < 200.0F && std::abs(ego.yaw_rate_radps) < 10.0F)) return false;
  const RangeRateConsensus::Support support = consensus_.test(scan, then);
  if (support.tested == 0) return false;
  if (!ego.has(ego_field::kReverse) && speed_mps < kFastestReverse_mps &&
      support.by_other[RangeRateConsensus::kOpposite] > support.by_ego) {
    return false;
  }
  add(support);
  const std::size_t least = is_dense() ? kLeastTested : kLeastTestedTracks;
  if (pool_.tested >= least && pool_.scans >= kLeastScans) {
    contradicts_ = contradicts();
    pool_ = {};
  }
  return contradicts_;
}

void EgoContradiction::add(const RangeRateConsensus::Support& support) {
  ++pool_.scans;
  pool_.reported += support.reported;
  pool_.tested += support.tested;
  pool_.by_ego += support.by_ego;
  pool_.by_chance += support.by_chance;
  pool_.alike += support.alike;
  for (std::size_t i = 0; i < support.by_other.size(); ++i) pool_.by_other[i] += support.by_other[i];
}

bool EgoContradiction::is_dense() const {
  return pool_.reported > kDenseRadar * pool_.scans;
}

bool EgoContradiction::contradicts() {
  const auto tested = static_cast<double>(pool_.tested), by_ego = static_cast<double>(pool_.by_ego);
  const auto other = static_cast<double>(*std::max_element(pool_.by_other.begin(), pool_.by_other.end()));
  const double distinct = tested - static_cast<double>(pool_.alike);
  const bool nothing_before = nothing_stood_still_;
  nothing_stood_still_ = is_dense() && by_ego < kNothing * tested;
  if (other > kOtherShare * tested && other > kOtherToEgo * by_ego) return true;
  const auto opposite = static_cast<double>(pool_.by_other[RangeRateConsensus::kOpposite]);
  if (opposite > kOppositeShare * tested && opposite - by_ego > kOppositeBeyondEgo * tested) return true;
  const double beyond_chance = by_ego - static_cast<double>(pool_.by_chance);
  const bool is_chance_distinct = is_dense() && distinct > (1.0 - kMostAlike) * tested;
  if (is_chance_distinct && beyond_chance < kBeyondChance * distinct) return true;
  return nothing_stood_still_ && nothing_before;
}

}  // namespace boresight::ingest
