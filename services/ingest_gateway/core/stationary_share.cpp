#include "services/ingest_gateway/core/stationary_share.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

/// Time over which the share is learnt (choice: longer than a traffic jam's first seconds, shorter than a kind of
/// road), and the time after which what was learnt counts as much as the prior (choice).
constexpr double kMemory_s = 60.0, kPrior_s = 5.0;
/// Deviations below the mean (choice: 2 % of scenes have less).
constexpr double kSigma = 2.0;
/// A radar of many detections reports the stationary world: the prior, and the least that is learnt from dense traffic.
/// No radar is held to more than the prior: under interference most detections are false, and the others still show how
/// the vehicle moves (choice: a fifth in dense traffic is no contradiction).
constexpr double kDensePrior = 0.3, kDenseLeast = 0.1;
/// A radar with no more detections may report tracks of moving objects only (choice: such radars have 12 … 20 tracks).
constexpr double kFewDetections = 20.0;
/// No share by chance is smaller (choice: the tolerance of 0.3 m/s in range rates that spread over 60 m/s).
constexpr double kLeastByChance = 0.01;

}  // namespace

void StationaryShare::learn(double share, double weight, double by_chance, std::size_t reported) {
  const auto mix = [](double& mean, double value, double part) { mean += part * (value - mean); };
  learnt_s_ = std::min(learnt_s_ + cycle_s_, kMemory_s);
  weight_s_ = std::min(weight_s_ + weight * cycle_s_, kMemory_s);
  const double slow = cycle_s_ / learnt_s_;
  mix(by_chance_, by_chance, slow);
  mix(reported_, static_cast<double>(reported), slow);
  if (!(weight > 0.0)) return;
  const double learnt = std::min(1.0, weight * cycle_s_ / weight_s_);
  mix(scene_, share, std::min(1.0, weight * cycle_s_ / std::min(weight_s_, scene_s_)));
  mix(mean_, share, learnt);
  mix(variance_, (scene_ - mean_) * (scene_ - mean_), learnt);
}

double StationaryShare::by_chance() const {
  return std::max(kLeastByChance, by_chance_);
}

double StationaryShare::least() const {
  const bool is_dense = reported_ > kFewDetections;
  const double weight = weight_s_ / (weight_s_ + kPrior_s);
  const double learnt = std::clamp(mean_ - kSigma * std::sqrt(variance_), 0.0, kDensePrior);
  const double least = weight * learnt + (1.0 - weight) * (is_dense ? kDensePrior : 0.0);
  return is_dense ? std::max(kDenseLeast, least) : least;
}

}  // namespace boresight::ingest
