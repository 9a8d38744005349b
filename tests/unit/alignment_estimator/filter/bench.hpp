// Runs a filter along a simulated drive and compares it with the truth.
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight::alignment {

/// A drive, the vehicle's ego history, and the filter.
class Bench {
 public:
  explicit Bench(const simulator::AlignmentSpec& spec, const FilterConfig& config = {})
      : drive(spec), vehicle(drive.vehicle()), filter(std::make_unique<WindowedFilter>(vehicle, config)) {}

  /// Runs until the given time of the drive (s since its start); `after` is called after each scan.
  void run(double until_s, const std::function<void(const simulator::AlignmentEvent&)>& after = {}) {
    simulator::AlignmentEvent event;
    while (time_s < until_s && drive.next(event)) {
      time_s = event.time_s - 1.0;
      if (event.ego != nullptr) {
        history.add(*event.ego);
        continue;
      }
      take_detections(*event.scan, vehicle.radars[event.radar], *scan);
      if (stationary_only) keep_stationary(*event.truth);
      if (change) change(event, *scan);
      ego = history.at(scan->time_ns);
      filter->process(event.radar, *scan, ego);
      if (after) after(event);
    }
  }
  /// Rotation vector of the estimate's error in vehicle axes, rad.
  [[nodiscard]] Eigen::Vector3d error_rad(std::size_t radar) const {
    const Eigen::Matrix3d truth = drive.sensor_to_vehicle(radar, time_s + 1.0);
    return geometry::so3_log(filter->estimate(radar).sensor_to_vehicle * truth.transpose());
  }

  simulator::AlignmentDrive drive;
  VehicleConfig vehicle;
  std::unique_ptr<WindowedFilter> filter;
  EgoHistory history;
  EgoSample ego;
  double time_s = 0.0;
  bool stationary_only = false;
  std::unique_ptr<ScanDetections> scan = std::make_unique<ScanDetections>();
  std::function<void(const simulator::AlignmentEvent&, ScanDetections&)> change;

 private:
  void keep_stationary(const std::vector<simulator::AlignmentDetectionTruth>& truth) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < scan->count; ++i) {
      if (!truth[i].stationary) continue;
      for (auto* column : {&scan->range_m, &scan->azimuth_rad, &scan->elevation_rad, &scan->range_rate_mps,
                           &scan->azimuth_std_rad, &scan->elevation_std_rad, &scan->range_rate_std_mps}) {
        (*column)[n] = (*column)[i];
      }
      ++n;
    }
    scan->count = n;
  }
};

}  // namespace boresight::alignment
