// Sudden misalignment of one radar: what its own blocks say, against the scatter that they have shown so far and
// against what the other radars say at the same time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/windows/block.hpp"

namespace boresight::alignment::windows {

/// Smallest step of a quantity that all radars share, and what is known of its scatter; see CommonWatch.
struct CommonConfig {
  double least = 0.0;           ///< smallest step that is reported
  double stds = 6.0;            ///< and in its own std
  double scatter = 0.0;         ///< std of a block before any block
  std::size_t after = 10;       ///< blocks since the step, at least
  double prior_blocks = 10.0;   ///< weight of `scatter` in the learnt one
  double between_radars = 0.0;  ///< std of one radar's value about the common one
  double later_share = 0.6;     ///< of the step that the later half of the blocks since must show: a burst is no step
};

struct ChangeConfig {
  double yaw_rad = 0.00785;          ///< smallest change that is reported, 0.45°
  double pitch_rad = 0.0157;         ///< 0.9°
  double scatter_factor = 6.5;       ///< a change exceeds the scatter of the means of earlier blocks by this
  double common_factor = 4.0;        ///< likewise, with the part that all radars share; and the std of pitch
  double yaw_scatter_rad = 0.00105;  ///< scatter before any block, 0.06°
  double pitch_scatter_rad = 0.0035;
  double least_detections = 50.0;   ///< of a block, stationary
  double prior_blocks = 10.0;       ///< weight of the two before in the learnt scatter
  std::size_t settled_blocks = 15;  ///< judged before the first report
  double unsure_s = 7.0;            ///< driving time before a report that is from both sides of the change
  /// The body's pitch (rad): least 0.25°, scatter 0.2°, between radars 0.1°.
  CommonConfig load{.least = 0.00436, .scatter = 0.0035, .between_radars = 0.00175};
  double load_wait_s = 5.0;              ///< driving time before the blocks that are compared, choice
  double load_after_restart_stds = 3.0;  ///< a load change between two drives is no surprise
  /// Scale of the speed signal.
  CommonConfig speed{.least = 0.005, .scatter = 0.001, .between_radars = 5e-4};
  double suspect_scale =
      0.003;                   ///< an error of the scale of one block that all radars show: then none has turned by it
  double drift_rad = 0.00175;  ///< smallest drift over Priors::drift_span_s that is reported, 0.1°
  double drift_stds = 4.0;     ///< and in its own std
  double watch_s = 14.0;       ///< driving time after which a load change that a restart allowed is decided
  double wait_s = 25.0;        ///< driving time before the first change is reported
  double settled_yaw_rad = 0.0052;  ///< and a radar's yaw is known better than this, 0.3°
};

/// What one block of one radar says about its rotation, with all else known to `known`.
struct Deviation2 {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();  ///< pitch and yaw (rad)
  Eigen::Vector2d std = Eigen::Vector2d::Zero();
  /// Std of the estimate that the value is counted from; 0: it does not limit a report. On a mirroring road the
  /// elevations, and so pitch, change with the scene.
  Eigen::Vector2d estimate_std = Eigen::Vector2d::Zero();
  bool valid = false;
};

/// Variances of rate scale, roll, and of pitch and yaw before the block. `common_scale`: error of the scale of the
/// range rates that all radars show, which is no turn of any of them.
[[nodiscard]] Deviation2 deviation_of(const Block& block, double scale_variance, double roll_variance,
                                      double rotation_variance, bool has_elevation, double common_scale,
                                      const ChangeConfig& config);

/// What one block of one radar says about the scale of its range rates, with its rotation known to these variances.
struct ScaleDeviation {
  double value = 0.0;
  double std = 0.0;  ///< 0: nothing
};
[[nodiscard]] ScaleDeviation scale_deviation_of(const Block& block, const Eigen::Vector3d& rotation_variances,
                                                double scale_variance, bool has_elevation, const ChangeConfig& config);

struct ChangeVerdict {
  bool suspect = false;  ///< the block must not be learnt from
  bool changed = false;
  Eigen::Vector2d turn_rad = Eigen::Vector2d::Zero();  ///< pitch and yaw of the change
};

class ChangeMonitor {
 public:
  static constexpr std::size_t kBlocks = 5;
  ChangeMonitor(std::size_t radars, const ChangeConfig& config) : config_(config), radars_(radars) {}
  /// Judges the latest block of every radar.
  void judge(const std::vector<Deviation2>& deviations, std::vector<ChangeVerdict>& verdicts);
  /// Number of judged windows of a radar.
  [[nodiscard]] std::size_t windows(std::size_t radar) const { return radars_[radar].history_size; }
  void restart(std::size_t radar);

 private:
  static constexpr std::size_t kHistory = 150;
  using History = std::array<double, kHistory>;
  struct Radar {
    std::array<Eigen::Vector2d, kBlocks> value, own, std;
    std::size_t size = 0, next = 0;
    std::array<History, 2> history{}, own_history{};  ///< sizes of the means, with and without the common part
    std::size_t history_size = 0, history_next = 0;
  };
  [[nodiscard]] double scatter(const History& history, std::size_t size, int axis) const;

  ChangeConfig config_;
  std::vector<Radar> radars_;
};

}  // namespace boresight::alignment::windows
