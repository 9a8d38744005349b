// The speed signal against the speeds that the radars see: missing, zero while the vehicle moves, or frozen.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/alignment_estimator/core/plausibility/velocity_window.hpp"
#include "services/common/estimation/ego_history.hpp"

namespace boresight::alignment::plausibility {

class SpeedSignal {
 public:
  explicit SpeedSignal(std::size_t radars) : radars_(radars) {}

  /// The motion at a scan's time.
  void add_signal(const EgoSample& ego, double time_s);
  /// A radar's velocity in the last half second, in vehicle axes under the nominal mounting.
  void add_velocity(std::size_t radar, const VelocityFit& fit, const Eigen::Vector2d& velocity_mps, double time_s);
  /// kEgoMotionMissing, kSpeedZero, kSpeedFrozen or kNone.
  [[nodiscard]] AlignmentFinding finding(double time_s) const;
  /// There is some evidence for a frozen signal, whose value says nothing about its unit.
  [[nodiscard]] bool may_be_frozen(double time_s) const;

 private:
  enum Fault : std::size_t { kMissing, kZero, kFrozen, kFaults };
  struct Radar {
    double seen_s = -1e9;        ///< time of the last window
    double moving_s = -1e9;      ///< and of the last one in which the vehicle moved, with its speed
    double speed_mps = 0.0;      //
    double scale = 0.0;          ///< seen / signalled speed while the signal changed; 0: unknown
    double reference_mps = 0.0;  ///< seen speed at the beginning of a signal that has never changed
    double reference_s = -1e9;
    std::array<double, kFaults> evidence{};  ///< logarithm of odds, limited
  };
  [[nodiscard]] bool is_alone(std::size_t radar, double time_s) const;
  [[nodiscard]] bool agrees(std::size_t radar, double speed_mps, double time_s) const;
  void clear(Fault fault);
  /// Sum of the evidence of active radars over the sufficient one.
  [[nodiscard]] double sum(Fault fault, double time_s) const;
  void judge_frozen(Radar& radar, double speed_mps, bool continues, double time_s);

  std::vector<Radar> radars_;
  double speed_mps_ = 0.0;
  double constant_since_s_ = -1e9;  ///< the speed has had this value since then
  double missing_since_s_ = 1e18;   ///< no valid motion since then
  bool is_zero_ = false;
  // Found, until there is a signal or until it changes: a standstill, or the right speed by chance, does not count.
  bool is_missing_ = false, is_frozen_ = false;
};

}  // namespace boresight::alignment::plausibility
