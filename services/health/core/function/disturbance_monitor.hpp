// Whether a radar's scans hold more detections that no scene explains than usual: interference by other radars.
#pragma once

#include <cstdint>

#include "services/health/core/faults/status.hpp"
#include "services/health/core/function/learnt_level.hpp"
#include "services/health/core/function/unexplained_detections.hpp"

namespace boresight::health {

struct DisturbanceConfig {
  ExplanationConfig explanation = {};
  double least_speed_mps = 5.0;  ///< from which the level is learnt; a standing vehicle meets fewer of them (choice)
  double smoothing_s = 1.0;      ///< of the numbers before they are compared with the level (choice)
  double learning_s = 10.0;      ///< motion until the level is known (choice)
  double memory_s = 600.0;       ///< motion over which the level is learnt (choice: longer than one kind of road)
  double least_log_std = 0.7;    ///< of the logarithm of the number, whatever was learnt (measured: RadarScenes)
  double sigma = 2.5;            ///< deviations from the level that are no scene (choice)
  double least_share = 0.35;     ///< of the detections that must be unexplained (choice)
  double passing_share = 0.7;    ///< of either limit, below which the test passes (choice: hysteresis)
  double unusual_share = 0.05;   ///< weight in learning of what is not usual (choice)
};

class DisturbanceMonitor {
 public:
  DisturbanceMonitor() : DisturbanceMonitor(DisturbanceConfig{}) {}
  explicit DisturbanceMonitor(const DisturbanceConfig& config);

  /// One scan at `time_ns`. Its numbers are judged at any speed, and learnt from the least one on.
  void observe(const ExplainedScan& scan, double speed_mps, std::int64_t time_ns);
  /// A scan that cannot be explained: without a known motion of the vehicle, or with wrong data.
  void skip() { time_.interrupt(); }

  [[nodiscard]] TestResult disturbed() const;
  /// Whether the level was learnt long enough.
  [[nodiscard]] bool is_known() const { return unexplained_.level.learnt_s() >= config_.learning_s; }

  [[nodiscard]] StoredLevel level() const { return unexplained_.level.stored(); }
  /// Continues with the level of an earlier process.
  void restore(const StoredLevel& level) { unexplained_.level.restore(level); }

 private:
  /// Of the smoothed numbers.
  [[nodiscard]] double share() const;

  DisturbanceConfig config_;
  LevelledQuantity unexplained_;  // logarithm of 1 + number per scan
  double detections_ = 0.0;       // smoothed logarithm of 1 + number per scan
  ScanTime time_;
};

}  // namespace boresight::health
