// The drives on which the estimators are judged. Every seed has its own mounting errors and k_v.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/alignment/spec.hpp"
#include "services/simulator/random.hpp"

namespace boresight::bench {

/// 1…2.5° of either sign, in rad; and a k_v of 0.98…1.02.
[[nodiscard]] double draw_mounting_error(simulator::Stream& stream);
[[nodiscard]] double draw_speed_scale(simulator::Stream& stream);

/// Four corner radars with each angle wrong by 1…2.5° of either sign, k_v 0.98…1.02, a quarter of the detections moving
/// or ghosts, no disturbance.
[[nodiscard]] simulator::AlignmentSpec clean_drive(simulator::RoadKind road, double duration_s, std::uint64_t seed);

/// The same with the disturbances of real vehicles: yaw-rate bias ±0.1°/s, rear-axle slip 0.003…0.006 rad per m/s²,
/// body pitch 0.3° (Ornstein–Uhlenbeck, 0.3 s), nose down by 0.2° per m/s² of braking.
[[nodiscard]] simulator::AlignmentSpec disturbed_drive(simulator::RoadKind road, double duration_s, std::uint64_t seed);

/// A kind of drive for the consistency of covariances: name and maker.
struct DriveKind {
  std::string name;
  simulator::AlignmentSpec (*make)(double duration_s, std::uint64_t seed);
};
[[nodiscard]] const std::vector<DriveKind>& drive_kinds();

}  // namespace boresight::bench
