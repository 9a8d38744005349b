// Interface of every alignment method, the product's own and the published ones. The service and the command-line tool
// run any of them by its name.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/alignment_estimator/core/memory/memory.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/common/estimation/ego_history.hpp"

namespace boresight::alignment {

/// Estimate of one radar and of the parameters that all radars share. Parameters in this order: k_v, then the rotation
/// d about the vehicle's x (roll), y and z (yaw) axes, R(actual) = Exp(d)·R(nominal), right-handed.
struct RadarEstimate {
  AlignmentState state = AlignmentState::kNoData;
  AlignmentReason reason = AlignmentReason::kNone;
  std::uint32_t observable = 0;  ///< alignment_axis bits, without those about the sensor's axes
  double speed_scale = 1.0;      ///< as this radar sees it, see AlignmentEstimate
  Eigen::Matrix3d sensor_to_vehicle = Eigen::Matrix3d::Identity();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of (k_v, d_x, d_y, d_z), as errors Exp(d)·R
  double yaw_rate_bias_radps = 0.0;                      ///< signalled = true + bias; 0 ± 0 where not estimated
  double yaw_rate_bias_std_radps = 0.0;
  double slip_coefficient_radps2pm = 0.0;  ///< c of V_y = −c·V·(V·ω)
  double slip_coefficient_std_radps2pm = 0.0;
  double angle_noise_scale = 1.0;
  double inlier_ratio = 0.0;  ///< share of stationary detections in recent scans
  std::uint64_t scans_used = 0;
  std::uint64_t detections_used = 0;
  double seconds_of_drive = 0.0;  ///< driving time with this radar
  AlignmentStepChange step_change{};
  AlignmentVehicleChange load_change{};
  AlignmentVehicleChange speed_change{};
  AlignmentDrift drift{};
  AlignmentNuisance nuisance{};  ///< zero where the method does not estimate it
};

class Method {
 public:
  Method() = default;
  virtual ~Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;

  /// Processes one scan of the radar at index `radar` in the vehicle's list, with the motion at its time. Scans come in
  /// the order of arrival; the radars need not be synchronised. Never allocates.
  virtual void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) = 0;
  [[nodiscard]] virtual RadarEstimate estimate(std::size_t radar) const = 0;
  /// Range rates (m/s) that the method's model predicts for the detections of a scan if they are stationary; `out` has
  /// scan.count places. Never allocates.
  virtual void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego,
                       std::span<double> out) const = 0;
  /// Memory over restarts and ignition cycles: writing and restoring, `away_s` after it was written (infinite: not
  /// known). A method without memory does nothing.
  virtual void save(Memory&) const {}
  virtual void restore(const Memory&, double /*away_s*/) {}
  /// Starts this radar from the rotation of a static calibration (vector d of R(actual) = Exp(d)·R(nominal), covariance
  /// of d in rad²). The rotation replaces the estimate at full weight, unlike a restored memory. Returns false and
  /// changes nothing if it is not finite or the method always starts from the nominal mounting. Never allocates.
  virtual bool seed(std::size_t /*radar*/, const Eigen::Vector3d& /*rotation_vehicle_rad*/,
                    const Eigen::Matrix3d& /*covariance*/) {
    return false;
  }
};

}  // namespace boresight::alignment
