// Settings of the windowed estimator.
#pragma once

#include "services/alignment_estimator/core/windows/change_monitor.hpp"
#include "services/alignment_estimator/core/windows/priors.hpp"

namespace boresight::alignment::windows {

/// Added to a memory from an earlier drive, beside what its fluctuations may have done since: the car may have been
/// repaired. Choice: a memory that doubts more costs seconds of driving, one that doubts less is wrong after a repair.
struct RestoreConfig {
  double rotation_std_rad = 0.00175;  ///< 0.1°
  double rate_scale_std = 3e-4;
  double speed_scale_std = 0.003;  ///< tyres and their pressure
  /// Share of the prior's standard deviation, for the vehicle's other parameters.
  double vehicle_share = 0.25;
};

struct WindowsConfig {
  Priors priors;
  ChangeConfig change;
  RestoreConfig restore;
};

}  // namespace boresight::alignment::windows
