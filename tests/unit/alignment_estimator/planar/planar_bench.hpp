// Runs the planar filter along a simulated drive that follows the planar model.
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "services/alignment_estimator/core/planar/planar_filter.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight::alignment::planar {

struct PlanarBench {
  explicit PlanarBench(const simulator::AlignmentSpec& s)
      : spec(s), drive(s), vehicle(drive.vehicle()), filter(std::make_unique<PlanarFilter>(vehicle, PlanarConfig{})) {}

  using Look = std::function<void(const simulator::AlignmentEvent&)>;
  /// Runs to the end of the drive; `before` may change the scan and the motion, `after` reads the filter.
  void run(const Look& before = {}, const Look& after = {}) {
    simulator::AlignmentEvent event;
    while (drive.next(event)) {
      if (event.ego != nullptr) {
        history.add(*event.ego);
        continue;
      }
      take_detections(*event.scan, vehicle.radars[event.radar], *scan);
      ego = history.at(scan->time_ns);
      if (before) before(event);
      filter->process(event.radar, *scan, ego);
      if (after) after(event);
    }
  }
  [[nodiscard]] Eigen::Vector4d truth(std::size_t radar) const {
    const auto& angles = spec.radars[radar].truth;
    return {spec.speed_scale, angles.yaw_rad, angles.pitch_rad, angles.roll_rad};
  }
  /// Error of (k_v, α, β, γ).
  [[nodiscard]] Eigen::Vector4d error(std::size_t radar) const { return filter->parameters(radar) - truth(radar); }

  simulator::AlignmentSpec spec;
  simulator::AlignmentDrive drive;
  VehicleConfig vehicle;
  std::unique_ptr<PlanarFilter> filter;
  EgoHistory history;
  EgoSample ego;
  std::unique_ptr<ScanDetections> scan = std::make_unique<ScanDetections>();
};

inline simulator::AlignmentSpec published_drive(double duration_s, std::uint64_t seed) {
  simulator::AlignmentSpec spec = simulator::published_setup();
  spec.duration_s = duration_s;
  spec.seed = seed;
  return spec;
}

}  // namespace boresight::alignment::planar
