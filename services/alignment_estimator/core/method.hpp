// What every alignment method offers, the product's own and the published ones, so that the service and the offline
// tool run any of them by its name.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/alignment_estimator/core/memory/memory.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/common/estimation/ego_history.hpp"

namespace boresight::alignment {

/// What a method believes of one radar and of what it shares with the others. Parameters in this order: k_v, then the
/// turn d about the vehicle's x (roll), y and z (yaw) axes, R(actual) = Exp(d)·R(nominal), right-handed.
struct RadarEstimate {
  AlignmentState state = AlignmentState::kNoData;
  std::uint32_t observable = 0;  ///< alignment_axis bits but those about the sensor's axes
  double speed_scale = 1.0;
  Eigen::Matrix3d sensor_to_vehicle = Eigen::Matrix3d::Identity();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of (k_v, d_x, d_y, d_z), as errors Exp(d)·R
  double yaw_rate_bias_radps = 0.0;                      ///< signalled = true + bias; 0 ± 0 where not estimated
  double yaw_rate_bias_std_radps = 0.0;
  double slip_coefficient_radps2pm = 0.0;  ///< c of V_y = −c·V·(V·ω)
  double slip_coefficient_std_radps2pm = 0.0;
  double angle_noise_scale = 1.0;
  double inlier_ratio = 0.0;  ///< share of the detections of recent scans that were believed stationary
  std::uint64_t scans_used = 0;
  std::uint64_t detections_used = 0;
  double seconds_of_drive = 0.0;  ///< spent estimating with this radar
  AlignmentStepChange step_change{};
};

class Method {
 public:
  Method() = default;
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  /// Takes one scan of the radar at `radar` in the vehicle's list, with the motion at its time. Scans come in the order
  /// of arrival, radars in any order and not synchronised. Never allocates.
  virtual void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) = 0;
  [[nodiscard]] virtual RadarEstimate estimate(std::size_t radar) const = 0;
  /// Range rates (m/s) that the method's model gives for the detections of a scan if they stand still; `out` has
  /// scan.count places. Never allocates.
  virtual void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego,
                       std::span<double> out) const = 0;
  /// What shall survive the ignition cycle, and taking it up again; a method that has nothing to remember does nothing.
  virtual void save(Memory&) const {}
  virtual void restore(const Memory&) {}
  /// A calibration has measured this radar's rotation now (vector d of R(actual) = Exp(d)·R(nominal), covariance of d,
  /// rad²): it replaces what was believed of it, at full weight, unlike what is only remembered. False, and nothing
  /// changes, if it is not finite or the method starts from nothing but the nominal mounting. Never allocates.
  virtual bool seed(std::size_t /*radar*/, const Eigen::Vector3d& /*rotation_vehicle_rad*/,
                    const Eigen::Matrix3d& /*covariance*/) {
    return false;
  }
};

}  // namespace boresight::alignment
