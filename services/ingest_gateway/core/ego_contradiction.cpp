#include "services/ingest_gateway/core/ego_contradiction.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

/// True if the vehicle's motion backwards explains the scan better than the others do.
bool may_reverse(const RangeRateConsensus::Support& support) {
  const auto& by = support.by_alternative;
  const std::size_t opposite = by[RangeRateConsensus::kOpposite];
  return opposite > std::max({support.by_ego, by[RangeRateConsensus::kMirrored], by[RangeRateConsensus::kRemembered]});
}

}  // namespace

EgoContradiction::EgoContradiction(const RadarConfig& radar, const ContradictionConfig& config)
    : config_(config),
      consensus_(radar),
      scene_scans_(std::max(1.0, config.scene_s / std::max(radar.cycle_time_s, 1e-3))),
      pooled_scans_(std::max(1.0, 0.5 * scene_scans_)),
      noise_scans_((1.0 + config.seen_again) / (1.0 - config.seen_again)),
      alternatives_(RangeRateConsensus::kAlternatives, SequentialTest(config.false_alarm, config.false_return)),
      chance_(config.false_alarm, config.false_return),
      share_(config, std::max(radar.cycle_time_s, 1e-3)),
      share_so_far_(share_) {}

bool EgoContradiction::judge(const RadarScan& scan, std::int64_t measurement_time_ns, const EgoMotion& ego) {
  if (!ego.has(ego_field::kSpeed | ego_field::kYawRate)) return false;
  EgoMotion then = ego;
  const double elapsed_s = static_cast<double>(measurement_time_ns - ego.header.measurement_time_ns) * 1e-9;
  if (std::abs(elapsed_s) < 1.0) {
    then.speed_mps += static_cast<float>(static_cast<double>(ego.longitudinal_acceleration_mps2) * elapsed_s);
  }
  const double speed_mps = std::abs(static_cast<double>(then.speed_mps));
  if (!(speed_mps > config_.least_speed_mps && speed_mps < 200.0 && std::abs(ego.yaw_rate_radps) < 10.0F)) return false;
  const RangeRateConsensus::Support support = consensus_.test(scan, then);
  if (support.tested == 0) return contradicts_;
  if (!ego.has(ego_field::kReverse) && speed_mps < config_.fastest_reverse_mps && may_reverse(support))
    return contradicts_;
  weigh_alternatives(support);
  weigh_chance(support);
  contradicts_ = chance_.contradicts() || std::any_of(alternatives_.begin(), alternatives_.end(),
                                                      [](const SequentialTest& test) { return test.contradicts(); });
  learn(support);
  return contradicts_;
}

/// What belongs to a contradiction is not learnt, from its first scan on.
void EgoContradiction::learn(const RangeRateConsensus::Support& support) {
  if (contradicts_) {
    share_so_far_ = share_;
    return;
  }
  const auto tested = static_cast<double>(support.tested), by_ego = static_cast<double>(support.by_ego);
  const auto by_chance = static_cast<double>(support.by_chance), distinct = static_cast<double>(support.distinct);
  if (support.is_clear) {
    share_so_far_.learn(by_ego / tested, 1.0, share_so_far_.by_chance(), support.reported);
  } else {
    const double beyond = (by_ego - by_chance) / std::max(1.0, (1.0 - by_chance / tested) * distinct);
    share_so_far_.learn(std::clamp(beyond, 0.0, 1.0), distinct / tested, by_chance / tested, support.reported);
  }
  if (chance_.is_settled()) share_ = share_so_far_;
}

void EgoContradiction::weigh_alternatives(const RangeRateConsensus::Support& support) {
  const auto tested = static_cast<double>(support.tested);
  const double chance =
      support.is_clear ? share_.by_chance() : (static_cast<double>(support.by_chance_of_one) + 0.5) / (tested + 1.0);
  const double share = std::max(config_.least_share, share_.least());
  // Log likelihood that a share of the detections is stationary for the motion, in relation to none.
  const double per_support = std::log1p(share / ((1.0 - share) * chance)), of_others = std::log1p(-share);
  const auto evidence = [&](std::size_t supporting) {
    return static_cast<double>(supporting) * per_support + tested * of_others;
  };
  // Sound: the vehicle's motion explains the stationary reflectors, or nothing stands still in this scan.
  const double sound = std::max(0.0, evidence(support.by_ego));
  for (std::size_t k = 0; k < RangeRateConsensus::kOtherScales; ++k) {
    alternatives_[k].add(evidence(support.by_alternative[k]) - sound, scene_scans_, scene_scans_);
  }
  // Two objects determine a velocity, so that it counts only for a radar that is known to see stationary reflectors.
  // Tracks of another radar last as long as a scene.
  const bool sees_the_road = share_.least() >= config_.least_share;
  for (const std::size_t k : {RangeRateConsensus::kMirrored, RangeRateConsensus::kRemembered}) {
    const bool is_mirrored = k == RangeRateConsensus::kMirrored;
    const double found = sees_the_road || is_mirrored ? evidence(support.by_alternative[k]) : 0.0;
    const double traffic = evidence(support.as_traffic[k - RangeRateConsensus::kMirrored]);
    const double dependent_scans = sees_the_road ? noise_scans_ : scene_scans_;
    alternatives_[k].add(found - std::max(sound, traffic), dependent_scans,
                         is_mirrored ? dependent_scans : scene_scans_);
  }
}

void EgoContradiction::weigh_chance(const RangeRateConsensus::Support& support) {
  constexpr double kMemory = 0.01;  // of chance_if_wrong_, per scan: some seconds
  pool_.add(support, std::min(share_.by_chance(), 0.5), 1.0 - 1.0 / pooled_scans_);
  const double share = share_.least(), tested = pool_.tested;
  const auto likelihood = [tested](double supporting, double probability) {
    return supporting * std::log(probability) + (tested - supporting) * std::log1p(-probability);
  };
  const auto probability = [](double supporting, double of) { return (supporting + 0.5) / (of + 1.0); };
  const double of_ego = probability(pool_.by_ego, tested), of_chance = probability(pool_.by_chance, tested);
  // Where random assignment makes no difference, stationary reflectors support the motion by chance, too.
  const double least = std::max(of_chance + share * (1.0 - of_chance) * pool_.distinct / tested, share);
  if (least <= of_chance) return;
  double of_both = probability(pool_.by_ego + pool_.by_chance, 2.0 * tested);
  const bool before = chance_.contradicts();
  if (before) {
    chance_if_wrong_ += kMemory * (of_both - chance_if_wrong_);
    of_both = chance_if_wrong_;
  }
  const double log_ratio = likelihood(pool_.by_ego, of_both) - likelihood(pool_.by_ego, std::max(least, of_ego)) +
                           likelihood(pool_.by_chance, of_both) - likelihood(pool_.by_chance, of_chance);
  chance_.add(log_ratio / pooled_scans_, noise_scans_, scene_scans_);
  if (chance_.contradicts() && !before) chance_if_wrong_ = of_both;
}

void EgoContradiction::Pool::add(const RangeRateConsensus::Support& support, double usual_chance, double keep) {
  const auto mix = [keep](double& sum, double value) { sum = keep * sum + value; };
  const auto number = static_cast<double>(support.tested);
  mix(tested, number);
  mix(by_ego, static_cast<double>(support.by_ego));
  mix(by_chance, support.is_clear ? usual_chance * number : static_cast<double>(support.by_chance));
  mix(distinct, support.is_clear ? number : static_cast<double>(support.distinct));
}

}  // namespace boresight::ingest
