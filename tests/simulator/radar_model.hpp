// What one radar measures of the world at an instant.
#pragma once

#include <cstdint>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "tests/simulator/world.hpp"

namespace boresight::simulator {

/// Where a simulated detection comes from.
struct DetectionTruth {
  Provenance provenance = Provenance::kUnknown;
  std::uint32_t object_id = 0;  ///< of the vehicle, also for its ghosts; 0 for the stationary world and clutter
};

class RadarModel {
 public:
  RadarModel(const RadarConfig& radar, const Scenario& scenario, std::uint64_t seed);

  /// Measures the world at `t_s`. Writes everything of `scan` but the header, and `truth` per detection. At most 300
  /// detections, the strongest candidates first come.
  void measure(const World& world, double t_s, std::uint32_t cycle, RadarScan& scan,
               std::vector<DetectionTruth>& truth) const;

 private:
  struct Target;
  struct Instant;
  void add_stationary(const Instant& scene, std::vector<Target>& targets) const;
  void add_vehicles(const World& world, const Instant& scene, std::vector<Target>& targets) const;
  void add_ghosts(const World& world, const Instant& scene, std::size_t index, const Eigen::Vector3d& target_position,
                  const Eigen::Vector3d& target_velocity, std::vector<Target>& targets) const;
  RadarConfig radar_;
  Scenario scenario_;
  std::uint64_t seed_;
  Eigen::Matrix3d actual_;  // sensor → vehicle, as really mounted
};

}  // namespace boresight::simulator
