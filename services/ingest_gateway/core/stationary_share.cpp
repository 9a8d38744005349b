#include "services/ingest_gateway/core/stationary_share.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

/// No share by chance is smaller (choice: the tolerance of 0.3 m/s in range rates that spread over 60 m/s).
constexpr double kLeastByChance = 0.01;

}  // namespace

void StationaryShare::learn(double share, double weight, double by_chance, std::size_t reported) {
  const auto mix = [](double& mean, double value, double part) { mean += part * (value - mean); };
  learnt_s_ = std::min(learnt_s_ + cycle_s_, config_.memory_s);
  weight_s_ = std::min(weight_s_ + weight * cycle_s_, config_.memory_s);
  const double slow = cycle_s_ / learnt_s_;
  mix(by_chance_, by_chance, slow);
  mix(reported_, static_cast<double>(reported), slow);
  if (!(weight > 0.0)) return;
  const double learnt = std::min(1.0, weight * cycle_s_ / weight_s_);
  mix(scene_, share, std::min(1.0, weight * cycle_s_ / std::min(weight_s_, config_.scene_s)));
  mix(mean_, share, learnt);
  mix(variance_, (scene_ - mean_) * (scene_ - mean_), learnt);
}

double StationaryShare::by_chance() const {
  return std::max(kLeastByChance, by_chance_);
}

double StationaryShare::least() const {
  const bool is_dense = reported_ > config_.few_detections;
  const double weight = weight_s_ / (weight_s_ + config_.prior_s);
  const double learnt = std::clamp(mean_ - config_.sigma * std::sqrt(variance_), 0.0, config_.usual_share);
  const double least = weight * learnt + (1.0 - weight) * (is_dense ? config_.usual_share : 0.0);
  return is_dense ? std::max(config_.least_share, least) : least;
}

}  // namespace boresight::ingest
