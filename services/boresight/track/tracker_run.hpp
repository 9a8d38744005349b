// A tracker over the scans of a simulated scenario.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/boresight/track/estimates.hpp"
#include "services/boresight/track/measurement_table.hpp"
#include "services/tracker/core/multi_object_tracker.hpp"

namespace boresight::track {

/// The scan of step `step`, measured at step × step_s by a radar in the origin. Every detection has a moving object as
/// its origin: the tracker judges by itself what is clutter.
void fill_scan(const std::vector<MeasuredPoint>& points, std::size_t step, double step_s, ClassifiedScan& scan);

struct TrackerRun {
  ObjectsByStep estimates;
  std::vector<double> cpu_ms;                                 ///< of each scan, the least of all passes
  std::size_t budget_reached = 0;                             ///< number of scans
  std::size_t gates_cut = 0;                                  ///< number of scans
  std::uint64_t dropped_detections = 0, dropped_objects = 0;  ///< over all scans
  std::uint64_t likelihood_evaluations = 0;                   ///< over all scans
  bool is_repeatable = true;                                  ///< all passes had the same estimates

  [[nodiscard]] double mean_cpu_ms() const;
  [[nodiscard]] double worst_cpu_ms() const;
};

using MakeTracker = std::function<std::unique_ptr<tracking::MultiObjectTracker>()>;

/// Runs a new tracker in each of `passes` passes; estimates and counts are those of the first. `cpu_time_ns` reads the
/// CPU time of the thread; it is called before and after each step of the tracker. `between_scans` may throw to end the
/// work.
[[nodiscard]] TrackerRun run_tracker(const MakeTracker& make, const std::vector<std::vector<MeasuredPoint>>& scans,
                                     double step_s, std::size_t passes, std::int64_t (*cpu_time_ns)(),
                                     const std::function<void()>& between_scans = {});

}  // namespace boresight::track
