// Errors of the estimated mountings and speed scales over a drive, false step changes, and wrong verdicts of health.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>

#include <Eigen/Core>

#include "services/simulator/judge/figure_list.hpp"

namespace boresight::judge {

/// Order of the four parameters: speed scale, rotation about the vehicle's x, y and z axes (rad).
inline constexpr std::size_t kAlignmentParameters = 4;

/// An estimate of one radar.
struct AlignmentSample {
  double t_s = 0.0;
  std::uint32_t radar = 0;
  double speed_scale = kNaN;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< actual × nominalᵀ, vehicle axes
  Eigen::Vector4d variances = Eigen::Vector4d::Zero();     ///< 0 or NaN: not given
  std::uint32_t step_changes = 0;
  double load_pitch_rad = kNaN;  ///< of the body since the start, positive with the nose up; NaN: not given
  double load_pitch_variance = kNaN;
};

struct MountingTruth {
  double speed_scale = kNaN;  ///< NaN: not known
  bool has_rotation = false;
  /// With the load at the start of the drive, which pitches all radars as a mounting error does.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double load_pitch_rad = 0.0;  ///< change of the body's pitch since then
  std::uint32_t step_changes = 0;
};

class AlignmentJudge {
 public:
  /// The rms errors are those after this time: the estimator has converged then. Choice.
  static constexpr double kConvergence_s = 60.0;
  /// A reported change is true if a true one of the same radar happened at most so long before. Choice.
  static constexpr double kLongestDetection_s = 60.0;

  /// In the order of time for each radar. Error = estimate − truth; for angles the vector e of the remaining rotation,
  /// R(estimate) = Exp(e) · R(truth).
  void add(const AlignmentSample& estimate, const MountingTruth& truth);
  /// Names "alignment.…".
  void write(FigureList& figures) const;

 private:
  /// The four parameters and the pitch by load.
  static constexpr std::size_t kJudged = kAlignmentParameters + 1;
  struct RadarErrors {
    double first_s = 0.0, last_s = 0.0;
    std::array<double, kJudged> error{kNaN, kNaN, kNaN, kNaN, kNaN}, squares{}, nees_sum{};
    std::array<double, kJudged> nees{kNaN, kNaN, kNaN, kNaN, kNaN};
    std::array<std::uint64_t, kJudged> samples{}, nees_samples{};
    std::uint32_t reported = 0, happened = 0;
    std::uint32_t false_changes = 0, found_changes = 0;
    std::deque<double> open_changes_s;
    bool knows_changes = false;
  };
  std::map<std::uint32_t, RadarErrors> radars_;
};

/// Verdicts on the mounting, held from one report to the next.
class HealthJudge {
 public:
  /// In the order of time for each radar.
  void add(double t_s, std::uint32_t radar, bool reported_misaligned, bool is_misaligned);
  /// Names "health.…".
  void write(FigureList& figures) const;

 private:
  struct RadarVerdicts {
    double last_s = 0.0;
    bool reported = false, is_so = false;
    double judged_s = 0.0, false_alarm_s = 0.0, missed_s = 0.0;
  };
  std::map<std::uint32_t, RadarVerdicts> radars_;
};

}  // namespace boresight::judge
