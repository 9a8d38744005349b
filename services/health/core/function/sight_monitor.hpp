// How much a radar sees while the vehicle moves, against what it is used to see. Dirt or ice on the cover takes
// detections away, first the far and weak ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "services/health/core/faults/status.hpp"

namespace boresight::health {

struct SightConfig {
  double least_speed_mps = 5.0;  ///< slower, a wall or a vehicle ahead may fill the view for long (choice)
  double smoothing_s =
      1.0;  ///< of detections and range, before they are compared with the level (choice: verdict in two seconds)
  double learning_s = 10.0;          ///< motion until the level is known (choice)
  double memory_s = 600.0;           ///< motion over which the level is learnt (choice: longer than one kind of road)
  double least_log_count_std = 0.7;  ///< of the logarithm of detections from road to road, whatever was learnt (choice)
  double least_log_range_std = 0.5;  ///< of the logarithm of the range (choice)
  double sigma = 3.0;                ///< deviations from the level that are no scene (choice: 99.9 %)
  double range_quantile = 0.9;  ///< share of the detections that the range of a scan covers (choice: not one stray)
  double passing_share = 0.7;   ///< of the deviation at which a test fails, above which it passes (choice: hysteresis)
  double blind_ratio = 0.11;    ///< share of the usual detections or range, below: blind (choice)
  double unusual_share = 0.05;  ///< weight in learning of what is not usual, so that no error lasts (choice)
};

/// A scan as the monitor sees it.
struct SeenScan {
  double detections = 0.0;
  double range_m =
      0.0;  ///< that the share `range_quantile` of the detections does not exceed; not used without detections
};

/// Level of one quantity: the mean and the variance of its smoothed logarithm, learnt with a fading memory.
class LearntLevel {
 public:
  LearntLevel() = default;
  explicit LearntLevel(double least_std) : variance_(least_std * least_std), least_std_(least_std) {}

  /// `value` over the last `dt_s` of motion.
  void learn(double value, double dt_s, double memory_s) {
    learnt_s_ = std::min(learnt_s_ + dt_s, memory_s);
    const double error = value - mean_;
    mean_ += dt_s / learnt_s_ * error;
    variance_ += dt_s / learnt_s_ * (error * error - variance_);
  }
  [[nodiscard]] double deviation(double value) const { return value - mean_; }
  [[nodiscard]] double std() const { return std::max(least_std_, std::sqrt(variance_)); }
  [[nodiscard]] double learnt_s() const { return learnt_s_; }

 private:
  double mean_ = 0.0;
  double variance_ = 0.0;
  double least_std_ = 0.0;
  double learnt_s_ = 0.0;
};

class SightMonitor {
 public:
  SightMonitor() : SightMonitor(SightConfig{}) {}
  explicit SightMonitor(const SightConfig& config);

  /// One scan at `time_ns`. Without a known speed, or below the least one, nothing is judged or learnt.
  void observe(const SeenScan& seen, double speed_mps, std::int64_t time_ns);

  [[nodiscard]] TestResult blind() const { return below(config_.blind_ratio); }
  [[nodiscard]] TestResult reduced() const { return below(1.0); }
  /// Whether the level was learnt long enough.
  [[nodiscard]] bool is_known() const { return count_.level.learnt_s() >= config_.learning_s; }

 private:
  struct Quantity {
    LearntLevel level;
    double smoothed = 0.0;
  };

  /// Whether the detections or the range are below that share of the usual, and further than any scene explains.
  [[nodiscard]] TestResult below(double ratio) const;
  [[nodiscard]] TestResult below(const Quantity& quantity, double ratio) const;
  void smooth(Quantity& quantity, double value, double share) const;

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  SightConfig config_;
  Quantity count_;
  Quantity range_;
  std::int64_t last_ns_ = kNever;  // of the last scan in motion
  double moved_s_ = 0.0;           // without interruption
  bool is_moving_ = false;
};

}  // namespace boresight::health
