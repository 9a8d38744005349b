// What share of a radar's detections agrees with the vehicle's motion while the radar is sound: learnt from its scans.
#pragma once

#include <cstddef>

#include "services/ingest_gateway/core/contradiction_config.hpp"

namespace boresight::ingest {

/// Mean and spread from scene to scene, of motion only. No allocation.
class StationaryShare {
 public:
  StationaryShare(const ContradictionConfig& config, double cycle_s) : config_(config), cycle_s_(cycle_s) {}

  /// Of one scan: the share of stationary detections beyond chance, its weight (1: as a scan in which chance is no
  /// explanation), the share that chance explains, and the number of reported detections.
  void learn(double share, double weight, double by_chance, std::size_t reported);
  /// Least share that a sound radar shows in a scene, by what was learnt. 0 for a radar that may report nothing but
  /// moving objects.
  [[nodiscard]] double least() const;
  /// Mean share by chance, above 0.
  [[nodiscard]] double by_chance() const;

 private:
  ContradictionConfig config_;
  double cycle_s_;
  double learnt_s_ = 0.0, weight_s_ = 0.0;
  double scene_ = 0.0;  // share in the present scene
  double mean_ = 0.0, variance_ = 0.0, by_chance_ = 0.1, reported_ = 0.0;
};

}  // namespace boresight::ingest
