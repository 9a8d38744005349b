// The reference method of the literature: per radar a yaw correction and the speed scale, from the range rates of
// stationary reflectors (Report A §8, "1-D azimuth reference").
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/core/residual_statistics.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// Recursive robust information filter over (k_v, yaw) of one radar. Errors of the ego signals, which all detections
/// of a scan share, are unknowns of the scan and eliminated, so that the covariance stays honest.
class Azimuth1d {
 public:
  Azimuth1d(const RadarConfig& radar, const Config& config);

  /// Takes one scan with the ego motion of its measurement time.
  void process(const RadarScan& scan, const EgoSample& ego);

  /// Writes everything but the header.
  void write(AlignmentEstimate& out) const;

  [[nodiscard]] AlignmentState state() const { return state_; }
  [[nodiscard]] double speed_scale() const { return x_(0); }
  [[nodiscard]] double yaw_rad() const { return x_(1); }
  /// Over (k_v, yaw), with the systematic part: the configured one, and what an elevation that is not measured leaves
  /// open of k_v.
  [[nodiscard]] Eigen::Matrix2d covariance() const;

 private:
  struct Candidate {
    Eigen::Vector3d direction;  // vehicle axes, nominal mounting
    double range_rate_mps;
    double variance;  // of the range rate, with the angles' share
  };
  void collect(const RadarScan& scan, const EgoSample& ego);
  void update(const EgoSample& ego, double elapsed_s);
  void count_residuals(const EgoSample& ego);
  [[nodiscard]] double start_std_mps() const;

  RadarConfig radar_;
  Config config_;
  Eigen::Matrix3d nominal_;
  Eigen::Vector2d x_{1.0, 0.0};
  Eigen::Matrix2d covariance_;
  /// Of the factor by which a common elevation, not measured, shortens all range rates; 0 where it is measured.
  double unknown_cosine_variance_ = 0.0;
  AlignmentState state_ = AlignmentState::kNoData;
  std::int64_t last_time_ns_ = 0;
  double seconds_of_drive_ = 0.0;
  std::uint64_t scans_used_ = 0;
  std::uint64_t detections_used_ = 0;
  ResidualStatistics residuals_;
  std::array<Candidate, kMaxDetections> candidates_;
  std::size_t number_of_candidates_ = 0;
};

}  // namespace boresight::alignment
