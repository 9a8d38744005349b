// Scans of a crowded road, consistent with one world over time: the load of the latency measurement.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/random.hpp"

namespace boresight::bench {

/// A scan lists detections of moving vehicles first, then false ones, then those of the stationary world.
inline constexpr std::uint32_t kVehiclesInScan = 10;
inline constexpr std::uint32_t kDetectionsOfVehicle = 3;
inline constexpr std::uint32_t kMovingDetections = kVehiclesInScan * kDetectionsOfVehicle;
inline constexpr std::uint32_t kFalseDetections = 30;
inline constexpr std::uint32_t kStationaryDetections = 240;
inline constexpr std::uint32_t kDetections = kMovingDetections + kFalseDetections + kStationaryDetections;

class CrowdedRoad {
 public:
  /// The own vehicle drives straight ahead in the middle of its lane. `detections`: of a scan; those beyond the moving
  /// and false ones are of the stationary world, which has so many more reflectors. At least 100.
  explicit CrowdedRoad(double ego_speed_mps, std::uint32_t detections = kDetections);

  /// What `radar` detects at `t_s`. The noise and the false detections are drawn anew for each `cycle`. Throws
  /// std::logic_error if the radar has too little in view.
  void measure(const RadarConfig& radar, double t_s, std::uint32_t cycle, RadarScan& scan) const;

 private:
  /// In axes over ground, with the origin where the own vehicle starts.
  struct Vehicle {
    Eigen::Vector2d start_m;
    double speed_mps;  ///< along the road; negative: oncoming
  };
  /// A place along the road relative to the own vehicle, which repeats beyond the range of the radars.
  [[nodiscard]] double along_m(double start_m, double speed_mps, double t_s) const;
  void add_moving(const RadarConfig& radar, double t_s, simulator::Stream& random, RadarScan& scan) const;
  void add_false(const RadarConfig& radar, simulator::Stream& random, RadarScan& scan) const;
  void add_stationary(const RadarConfig& radar, double t_s, simulator::Stream& random, RadarScan& scan) const;

  double ego_speed_mps_;
  std::uint32_t stationary_detections_;
  std::vector<Vehicle> vehicles_;
  std::vector<Eigen::Vector2d> reflectors_m_;  ///< that stand
};

}  // namespace boresight::bench
