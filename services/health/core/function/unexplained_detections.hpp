// Which detections of a scan no scene explains: neither a stationary reflector nor an object that the scan before saw.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::health {

struct ExplanationConfig {
  /// Largest deviation from the range rate of a stationary reflector: a constant part (choice: four standard deviations
  /// of the weakest, micro-motion) and a share of the speed (choice: an error of 3° in direction).
  double stationary_tolerance_mps = 2.0;
  double stationary_tolerance_ratio = 0.05;
  double neighbour_distance_m = 5.0;      ///< within which a moving object is seen again (choice: a car's length)
  double neighbour_range_rate_mps = 2.5;  ///< largest difference of its range rates (choice: turning and braking)
  /// Highest speed in reverse: up to it, a vehicle without a signal of its direction may do either (choice).
  double fastest_reverse_mps = 10.0;
  double longest_interval_s = 0.3;  ///< from scan to scan, in which an object stays in place (choice)
};

/// Motion of the vehicle that the range rates are compared with.
struct VehicleMotion {
  double speed_mps;        ///< NaN: unknown
  double yaw_rate_radps;   ///< 0 if it is not known
  bool is_signed = false;  ///< the direction of travel is known and in the sign of the speed
};

/// Numbers of a scan.
struct ExplainedScan {
  double detections = 0.0;   ///< that the sensor does not forbid to use
  double unexplained = 0.0;  ///< of them
};

/// The range rates of stationary reflectors follow from the vehicle's motion and the mounting. A moving object, its
/// mirror images and side lobes are seen again near the place that its range rate predicts. Random detections are
/// neither. No allocation.
class UnexplainedDetections {
 public:
  UnexplainedDetections(const RadarConfig& radar, const ExplanationConfig& config);

  /// Nothing without a known speed, and for the first scan after a pause.
  [[nodiscard]] std::optional<ExplainedScan> explain(const RadarScan& scan, const VehicleMotion& motion);

 private:
  /// A detection that is not stationary.
  struct Moving {
    float range_m;
    float azimuth_rad;
    float range_rate_mps;
  };
  /// The moving detections of a scan, sorted by range.
  struct MovingOnes {
    std::array<Moving, kMaxDetections> detections;
    std::size_t count = 0;
    std::int64_t time_ns = 0;
  };
  /// Fills `moving` and returns the number of usable detections.
  [[nodiscard]] std::size_t collect(const RadarScan& scan, const VehicleMotion& motion, MovingOnes& moving) const;
  [[nodiscard]] std::size_t count_new(const MovingOnes& before, const MovingOnes& now) const;

  ExplanationConfig config_;
  Eigen::Matrix3d to_vehicle_;
  std::array<double, 3> position_m_;
  std::array<MovingOnes, 2> scans_;  // the present one and the one before
  std::size_t present_ = 0;
  bool has_before_ = false;
};

}  // namespace boresight::health
