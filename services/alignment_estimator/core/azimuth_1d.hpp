// The reference method of the literature: per radar a yaw correction and the speed scale, from the range rates of
// stationary reflectors (Report A §8, "1-D azimuth reference").
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/alignment_estimator/core/scene_statistics.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// Recursive robust information filter over k_v and yaw of one radar, by way of p = k_v·(cos yaw, sin yaw), in which
/// the range rate is linear but for the turning: what cannot be told apart stays so, whatever the estimate is
/// meanwhile. Three things keep the covariance honest: errors of the ego signals, which all detections of a scan share,
/// are unknowns of the scan and eliminated; gradients are taken at the line of sight that fits best, since the noise of
/// the angles is in both sides of the equation (errors in variables, Report A §1.4), and the information that this
/// noise feigns is taken off; nothing is claimed before a stationary world stands out of the background.
class YawFilter {
 public:
  YawFilter(const RadarConfig& radar, const Config& config);

  /// Takes one scan with the ego motion of its measurement time.
  void process(const RadarScan& scan, const EgoSample& ego);
  void process(const ScanDetections& scan, const EgoSample& ego);

  /// Writes everything but the header.
  void write(AlignmentEstimate& out) const;

  [[nodiscard]] AlignmentState state() const { return state_; }
  [[nodiscard]] std::uint64_t scans_used() const { return scans_used_; }
  [[nodiscard]] std::uint64_t detections_used() const { return detections_used_; }
  [[nodiscard]] double seconds_of_drive() const { return seconds_of_drive_; }
  [[nodiscard]] double inlier_ratio() const { return residuals_.inlier_ratio(); }
  /// 1 and 0 while no stationary world was seen.
  [[nodiscard]] double speed_scale() const { return supported().p.norm(); }
  [[nodiscard]] double yaw_rad() const;
  /// Over (k_v, yaw), with the systematic part: the configured one, and what an elevation that is not measured leaves
  /// open of k_v.
  [[nodiscard]] Eigen::Matrix2d covariance() const;

 private:
  struct Candidate {
    Eigen::Vector3d direction;  // vehicle axes, nominal mounting
    Eigen::Vector3d across;     // derivative of the direction to the azimuth
    double range_rate_mps;
    double azimuth_variance;
    double other_variance;  // of the range rate, with the elevation's share
  };
  /// What the data support of p; along what they do not, it is the prior.
  struct Supported {
    Eigen::Vector2d p;
    Eigen::Matrix2d covariance;
  };
  [[nodiscard]] Supported supported() const;
  void collect(const ScanDetections& scan, const EgoSample& ego);
  void drift(double elapsed_s);
  void update(const EgoSample& ego);
  void count_residuals(const EgoSample& ego);
  void judge_scene();
  void restart();
  [[nodiscard]] double start_std_mps() const;

  RadarConfig radar_;
  Config config_;
  Eigen::Matrix3d nominal_;
  Eigen::Matrix2d prior_information_;
  Eigen::Vector2d p_{1.0, 0.0};
  Eigen::Matrix2d covariance_;                         // of p, with feigned information
  Eigen::Matrix2d feigned_ = Eigen::Matrix2d::Zero();  // information that the noise of azimuths feigns
  bool stationary_seen_ = false;
  double since_start_s_ = 0.0;
  /// Of the factor by which a common elevation, not measured, shortens all range rates; 0 where it is measured.
  double unknown_cosine_variance_ = 0.0;
  AlignmentState state_ = AlignmentState::kNoData;
  std::int64_t last_time_ns_ = 0;
  double seconds_of_drive_ = 0.0;
  std::uint64_t scans_used_ = 0;
  std::uint64_t detections_used_ = 0;
  SceneStatistics residuals_;
  std::array<Candidate, kMaxDetections> candidates_;
  std::size_t number_of_candidates_ = 0;
  ScanDetections detections_;
};

}  // namespace boresight::alignment
