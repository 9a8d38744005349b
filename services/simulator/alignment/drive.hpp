// The messages of a statistical alignment drive, in the order of measurement.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/simulator/alignment/spec.hpp"

namespace boresight::simulator {

/// Truth of one detection.
struct AlignmentDetectionTruth {
  bool stationary = true;
  double azimuth_rad = 0.0;  ///< both angles without noise and without distortion by the car
  double elevation_rad = 0.0;
};

/// Exactly one of the first two is set. All pointers are valid until the next call.
struct AlignmentEvent {
  double time_s = 0.0;  ///< of measurement; the stamp of a scan may be later
  const EgoMotion* ego = nullptr;
  const RadarScan* scan = nullptr;
  std::size_t radar = 0;  ///< index of the scan's radar
  const std::vector<AlignmentDetectionTruth>* truth = nullptr;
  /// True motion at this instant: speed, yaw rate, lateral speed at the rear axle, vertical speed by pitch of the body.
  double speed_mps = 0.0, yaw_rate_radps = 0.0, lateral_speed_mps = 0.0, vertical_speed_mps = 0.0;
};

class AlignmentDrive {
 public:
  static constexpr double kStart_s = 1.0;  ///< measurement time of the first messages

  explicit AlignmentDrive(const AlignmentSpec& spec);
  ~AlignmentDrive();
  AlignmentDrive(const AlignmentDrive&) = delete;
  AlignmentDrive& operator=(const AlignmentDrive&) = delete;

  /// False at the end. An ego motion precedes the scans of the same time. Measurement times start at kStart_s.
  [[nodiscard]] bool next(AlignmentEvent& event);
  /// The vehicle as configured (nominal), for the estimator.
  [[nodiscard]] VehicleConfig vehicle() const;
  /// R(sensor→vehicle) of a radar's true mounting at that time.
  [[nodiscard]] Eigen::Matrix3d sensor_to_vehicle(std::size_t radar, double time_s) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace boresight::simulator
