// Settings of the batch estimator. All are choices: they trade computing time against accuracy.
#pragma once

#include <cstddef>

namespace boresight::alignment::batch {

struct BatchConfig {
  double block_s = 1.0;         ///< driving time over which the point of linearisation holds, as in the windowed filter
  double window_s = 5.0;        ///< shortest window
  double least_drive_s = 15.0;  ///< driving time below which there is no result: three windows to leave out
  int most_passes = 8;          ///< over the recording, with the first
  double moved_stds = 0.1;      ///< a pass that moves no parameter by more than this is the last
  double solved_stds = 0.01;    ///< likewise for the solutions within a pass
  int most_solutions = 25;      ///< of a pass
  /// Driving time before the report of a sudden misalignment that is from both sides of it; longest time from a change
  /// of the load to its report.
  double step_change_delay_s = 7.0, load_delay_s = 60.0;
};

}  // namespace boresight::alignment::batch
