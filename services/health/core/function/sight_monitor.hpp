// How much a radar sees while the vehicle moves, against what it is used to see. Dirt or ice on the cover takes
// detections away, first the far and weak ones.
#pragma once

#include <cstdint>

#include "services/health/core/faults/status.hpp"
#include "services/health/core/function/learnt_level.hpp"

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
  double least_detections =
      2.0;                      ///< fewer over `learning_s` of motion: blind, before a level is known (choice: strays)
  double least_range_m = 10.0;  ///< that the detections reach, likewise (choice)
};

/// A scan as the monitor sees it.
struct SeenScan {
  double detections = 0.0;
  double range_m =
      0.0;  ///< that the share `range_quantile` of the detections does not exceed; not used without detections
  bool is_sound = true;  ///< false: data of doubtful integrity are judged, but teach no level
};

/// What a radar is used to see.
struct SightLevels {
  StoredLevel log_count, log_range;
};

class SightMonitor {
 public:
  SightMonitor() : SightMonitor(SightConfig{}) {}
  explicit SightMonitor(const SightConfig& config);

  /// One scan at `time_ns`. Without a known speed, or below the least one, nothing is judged or learnt.
  void observe(const SeenScan& seen, double speed_mps, std::int64_t time_ns);

  [[nodiscard]] TestResult blind() const;
  [[nodiscard]] TestResult reduced() const { return below(1.0); }
  /// Whether the level was learnt long enough.
  [[nodiscard]] bool is_known() const { return count_.level.learnt_s() >= config_.learning_s; }

  [[nodiscard]] SightLevels levels() const { return {count_.level.stored(), range_.level.stored()}; }
  /// Continues with the levels of an earlier process.
  void restore(const SightLevels& levels);

 private:
  /// Whether the detections or the range are below that share of the usual, and further than any scene explains.
  [[nodiscard]] TestResult below(double ratio) const;
  [[nodiscard]] TestResult below(const LevelledQuantity& quantity, double ratio) const;
  /// Less than radars see at all. A level is not needed for that, and none is learnt of it.
  [[nodiscard]] bool sees_nothing() const;
  /// Whether the radar is known to have so few detections that their absence is a scene.
  [[nodiscard]] bool has_few() const;

  SightConfig config_;
  LevelledQuantity count_;  // logarithm of 1 + detections
  LevelledQuantity range_;  // logarithm of the range in metres
  ScanTime motion_;
  double saw_nothing_s_ = 0.0;  // motion since there was sight
  bool is_moving_ = false;
};

}  // namespace boresight::health
