// The stationary detections of a scan, and a memory of those of the last scans, in axes that stand still.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/geometry/ego_step.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/surroundings/parameters.hpp"

namespace boresight::tracking {

/// A stationary detection in the vehicle frame of the present scan.
struct StationaryPoint {
  Eigen::Vector2d position_m;
  Eigen::Matrix2d covariance_m2;  ///< of the radar's noise and its mounting
  double range_m = 0.0;
  double excess_db = 0.0;  ///< strength over the radar's usual one at this range; 0 if it states none
  bool has_strength = false;
  std::uint32_t scan = 0;  ///< counts the scans
};

/// Vehicle frame of the present scan within standing axes: those of the first scan.
struct StandingAxes {
  Eigen::Vector2d position_m{0.0, 0.0};
  double heading_rad = 0.0;
};

class StationaryMemory {
 public:
  StationaryMemory(const VehicleConfig& vehicle, const StationaryParameters& parameters,
                   const ObstacleParameters& strengths);

  void clear();
  /// Moves the vehicle, then takes the scan's detections. `elapsed_s` may be negative: a scan that finished late.
  void step(const ClassifiedScan& scan, const geometry::EgoStep& step, double yaw_rad, double elapsed_s);

  /// Of the present scan; empty if the scan is of no use.
  [[nodiscard]] std::span<const StationaryPoint> scan() const { return scan_; }
  /// Position in the vehicle frame, of the present and the last scans. Empty in every other scan, to save time.
  [[nodiscard]] std::span<const Eigen::Vector2d> places() const { return places_; }
  /// Index of the radar in the vehicle, or −1: its scan is of no use.
  [[nodiscard]] int radar() const { return radar_; }

  static constexpr std::size_t kCapacity = 4096;

 private:
  struct Remembered {
    Eigen::Vector2d standing_m;
    double time_s;
  };
  static constexpr std::size_t kLevels = 8;
  struct Radar {
    std::uint32_t id;
    SensorNoise noise;
    double level_db[kLevels] = {}, weight[kLevels] = {};
  };
  void read(const ClassifiedScan& scan, double elapsed_s);
  [[nodiscard]] double excess(Radar& radar, double range_m, double strength_db, double share) const;

  StationaryParameters parameters_;
  ObstacleParameters strengths_;
  std::vector<Radar> radars_;
  std::vector<StationaryPoint> scan_;
  std::vector<Remembered> ring_;
  std::size_t next_ = 0;
  std::vector<Eigen::Vector2d> places_;
  StandingAxes axes_;
  double time_s_ = 0.0, newest_s_ = 0.0;
  std::uint32_t scans_ = 0;
  int radar_ = -1;
};

}  // namespace boresight::tracking
