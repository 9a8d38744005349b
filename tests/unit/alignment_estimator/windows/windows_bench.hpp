// Runs the windowed filter along a simulated drive and compares it with the truth.
#pragma once

#include <functional>
#include <memory>

#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight::alignment::windows {

/// Four corner radars on a clean drive.
inline simulator::AlignmentSpec corner_drive(std::uint64_t seed, double duration_s) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.seed = seed;
  spec.duration_s = duration_s;
  return spec;
}

/// Four aligned corner radars on a real car.
inline simulator::AlignmentSpec aligned_real_car(std::uint64_t seed, double duration_s) {
  simulator::AlignmentSpec spec = corner_drive(seed, duration_s);
  for (simulator::AlignmentRadar& radar : spec.radars) radar.truth = {};
  spec.real_car = simulator::car::real_car_preset();
  spec.real_car.load_pitch_rad = 0.0;
  return spec;
}

/// A drive, the vehicle's ego history, and the filter.
class WindowsBench {
 public:
  explicit WindowsBench(const simulator::AlignmentSpec& spec, const WindowsConfig& settings = {})
      : drive(spec), vehicle(drive.vehicle()), config(settings) {
    restart();
  }
  /// A new filter.
  void restart() { filter = std::make_unique<WindowedFilter>(vehicle, FilterConfig{}, config); }

  /// Runs until the given time of the drive (s since its start); `instead` is called for each scan.
  void run(double until_s, const std::function<void(const simulator::AlignmentEvent&)>& instead = {}) {
    simulator::AlignmentEvent event;
    while (time_s < until_s && drive.next(event)) {
      time_s = event.time_s - simulator::AlignmentDrive::kStart_s;
      if (event.ego != nullptr) {
        history.add(*event.ego);
        continue;
      }
      take_detections(*event.scan, vehicle.radars[event.radar], *scan);
      ego = history.at(scan->time_ns);
      if (instead) {
        instead(event);
      } else {
        filter->process(event.radar, *scan, ego);
      }
    }
  }
  /// Rotation vector of the estimate's error in vehicle axes, rad.
  [[nodiscard]] Eigen::Vector3d error_rad(const WindowedFilter& of, std::size_t radar) const {
    const Eigen::Matrix3d truth = drive.sensor_to_vehicle(radar, time_s + simulator::AlignmentDrive::kStart_s);
    return geometry::so3_log(of.estimate(radar).sensor_to_vehicle * truth.transpose());
  }
  [[nodiscard]] Eigen::Vector3d error_rad(std::size_t radar) const { return error_rad(*filter, radar); }

  simulator::AlignmentDrive drive;
  VehicleConfig vehicle;
  WindowsConfig config;
  std::unique_ptr<WindowedFilter> filter;
  EgoHistory history;
  EgoSample ego;
  double time_s = 0.0;
  std::unique_ptr<ScanDetections> scan = std::make_unique<ScanDetections>();
};

inline double std_of(const RadarEstimate& estimate, int parameter) {
  return std::sqrt(estimate.covariance(parameter, parameter));
}

}  // namespace boresight::alignment::windows
