// A repeated stretch of driving, prepared in memory in the form that methods read: for measuring their cost.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::bench {

class Load {
 public:
  /// At most kMaxDetections per scan.
  Load(std::size_t radars, double detections_per_scan, double seconds);

  [[nodiscard]] const VehicleConfig& vehicle() const { return vehicle_; }
  /// Gives the method the next scan; returns the number of detections.
  std::size_t give_scan(alignment::Method& method);
  /// Gives the method one scan of each radar; returns the number of detections.
  std::size_t give_cycle(alignment::Method& method);
  /// Runs through all scans once, so that the method has started.
  void warm_up(alignment::Method& method);

 private:
  struct Entry {
    std::size_t radar;
    EgoSample ego;
    std::unique_ptr<alignment::ScanDetections> detections;
  };
  VehicleConfig vehicle_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
  std::int64_t duration_ns_;
};

/// Time of a cycle of all radars, over `cycles`, after warming up.
struct CycleCost {
  double us_per_cycle;      ///< median
  double ns_per_detection;  ///< median
  double mean_us;           ///< per cycle, of the thread's CPU time: with work that is not done in each cycle
  std::size_t allocations;
};
[[nodiscard]] CycleCost measure_cycles(Load& load, alignment::Method& method, std::size_t cycles);
/// Each call of process() in as many cycles (ms of the thread's CPU time); does not warm up.
[[nodiscard]] std::vector<double> call_times_ms(Load& load, alignment::Method& method, std::size_t cycles);
/// Number of heap allocations; does not warm up.
[[nodiscard]] std::size_t count_allocations(Load& load, alignment::Method& method, std::size_t cycles);

}  // namespace boresight::bench
