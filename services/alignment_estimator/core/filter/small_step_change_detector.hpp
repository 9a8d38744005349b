// Finds changes of one radar's mounting that are too small for StepChangeDetector; separating them from noise takes
// longer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/header.hpp"
#include "services/alignment_estimator/core/filter/config.hpp"

namespace boresight::alignment {

/// Cumulative sums of each radar's own deviation from its estimate about the vehicle's x, y and z axes, in units of its
/// σ. That σ combines the window's data, the estimate, the comparison with other radars, and unmodelled effects. An
/// axis that a window hardly measures therefore needs more windows. The median of the other radars is subtracted, as in
/// StepChangeDetector. A sum beyond its limit is a suspicion; the next window, whose data are not in the sum, confirms
/// or drops it.
class SmallStepChangeDetector {
 public:
  SmallStepChangeDetector(std::size_t radars, const FilterConfig& config);

  /// Adds one scan of a running radar: information and score about the vehicle's axes at the present estimate, and the
  /// covariance of that estimate (rad²). At the end of a window, returns the set of radars (bit by index) whose
  /// mounting changed.
  [[nodiscard]] std::uint32_t add(std::size_t radar, std::int64_t time_ns, const Eigen::Matrix3d& information,
                                  const Eigen::Vector3d& score, const Eigen::Matrix3d& covariance);
  /// Clears a radar's sums (new estimate).
  void clear(std::size_t radar);

  /// Deviation of the radar in the window that confirmed the change, about x, y, z in rad; and the axes that changed.
  [[nodiscard]] const Eigen::Vector3d& change(std::size_t radar) const { return radars_[radar].own; }
  [[nodiscard]] bool changed(std::size_t radar, std::size_t axis) const { return radars_[radar].axes[axis].confirmed; }
  /// Whether a change of yaw or pitch is so likely that the estimate should be frozen until the decision.
  [[nodiscard]] bool doubted(std::size_t radar) const;
  /// The larger of the axis's two sums with its sign, over the limit of a suspicion; and the deviation of the last
  /// window in its σ.
  [[nodiscard]] double sum(std::size_t radar, std::size_t axis) const;
  [[nodiscard]] double deviation(std::size_t radar, std::size_t axis) const { return radars_[radar].axes[axis].stds; }
  /// Deviation in σ of the window after a suspicion that confirms it.
  [[nodiscard]] static double confirming_stds(const FilterConfig& config, std::size_t axis);

 private:
  /// The present window of an axis; each axis has its own window length.
  struct Axis {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d score = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the estimate when the window began
    int joined = 0;
    bool active = false;
    // Of the last window.
    double deviation_rad = 0.0, variance = 0.0, stds = 0.0;
    bool known = false, ended = false, confirmed = false;
    // Over windows.
    std::array<double, 2> sums{};  // +, −
    int suspected = 0;             // sign of a suspicion
  };
  struct Radar {
    std::array<Axis, 3> axes;
    Eigen::Vector3d own = Eigen::Vector3d::Zero();
  };
  void close(std::size_t axis);
  [[nodiscard]] bool judge(std::size_t radar, std::size_t axis);

  FilterConfig config_;
  std::size_t number_;
  std::array<std::int64_t, 3> window_{};
  std::array<Radar, kMaxRadars> radars_;
};

}  // namespace boresight::alignment
