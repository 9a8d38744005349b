// Scans of one radar, linearised at a given point of the model and summed into blocks.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/filter/efficiency.hpp"
#include "services/alignment_estimator/core/filter/noise_scale.hpp"
#include "services/alignment_estimator/core/filter/scan_motion.hpp"
#include "services/alignment_estimator/core/filter/sightings.hpp"
#include "services/alignment_estimator/core/windows/block.hpp"
#include "services/alignment_estimator/core/windows/solver.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/estimation/unknown_elevation.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::batch {

[[nodiscard]] windows::Knots knots_of(const RadarConfig& radar);

class RadarSums {
 public:
  RadarSums(const RadarConfig& radar, const FilterConfig& config, const windows::Priors& priors, double noise_memory_s);

  /// Begins a block at this point; the solution's uncertainty widens the gate.
  void begin_block(const windows::Point& point, const windows::Solver& solver, std::size_t radar);
  /// Adds a scan; `sightings` is work space. False: too few detections.
  bool add(const ScanDetections& scan, const ScanMotion3d& motion, const EgoSample& ego, Sightings& sightings);
  /// A further pass over the same scans begins: noise and efficiency stay.
  void begin_pass();
  void set_angle_noise_scale(double scale) { noise_.set_angle_scale(scale); }

  [[nodiscard]] const windows::Block& block() const { return block_; }
  [[nodiscard]] const Eigen::Matrix3d& linearised() const { return block_.point.sensor_to_vehicle; }
  [[nodiscard]] const windows::Knots& knots() const { return knots_; }
  [[nodiscard]] double angle_noise_scale() const { return std::sqrt(noise_.angle_variance_factor()); }
  [[nodiscard]] double stationary_share() const { return detections_ > 0.0 ? stationary_ / detections_ : 0.0; }
  [[nodiscard]] std::uint64_t scans() const { return scans_; }
  [[nodiscard]] std::uint64_t inliers() const { return inliers_; }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  RadarConfig config_;
  FilterConfig filter_;
  double noise_memory_s_;
  UnknownElevation unknown_;
  windows::Knots knots_;
  NoiseScale noise_;
  Efficiency efficiency_;
  windows::Block block_;
  /// Of the parameters that widen the gate, and of the curve at any azimuth.
  Eigen::Matrix<double, windows::local::kCurve, windows::local::kCurve> gate_covariance_;
  double curve_variance_ = 0.0;
  double body_pitch_std_rad_ = 0.0, side_slip_std_rad_ = 0.0;
  std::int64_t last_time_ns_ = 0;
  double detections_ = 0.0, stationary_ = 0.0, seconds_ = 0.0;
  std::uint64_t scans_ = 0, inliers_ = 0;
};

}  // namespace boresight::alignment::batch
