// Common base of the published methods: from a scan to the sums over its detections, and the book-keeping.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/published/config.hpp"
#include "services/alignment_estimator/core/published/draw.hpp"
#include "services/alignment_estimator/core/published/normal_equations.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::published {

/// Input of a method for one step.
struct ScanView {
  const MountingPose& nominal;
  const ScanDetections& detections;
  double speed_mps;
  double yaw_rate_radps;  ///< 0 for the straight-road model
  int parameters;         ///< number of estimated parameters of (k_v, α, β, γ): the first 2 or all 4
  Eigen::Vector4d b;      ///< the estimate before the step
  std::span<const std::uint16_t> selected;  ///< indices of the detections to use
  NormalEquations equations;                ///< over these, at b; gradients of fixed parameters are 0

  [[nodiscard]] PlanarModel model(const Eigen::Vector4d& at) const { return {nominal, at, speed_mps, yaw_rate_radps}; }
  /// Model − measured, m/s; for ambiguous range rates the residual to the nearest multiple.
  [[nodiscard]] double residual(double model_mps, std::size_t detection) const {
    const double r = model_mps - detections.range_rate_mps[detection];
    return detections.ambiguity_mps > 0.0 ? std::remainder(r, detections.ambiguity_mps) : r;
  }
};

/// Every radar has its own angles, all share k_v. Burza 2025 steps all radars at once, with the mean of their steps of
/// k_v. Here scans come one radar at a time, and each moves k_v by its own step divided by the number of radars that
/// currently deliver. For synchronised radars both agree to first order in the step.
///
/// A radar without elevation gets elevation 0, and only k_v and α are estimated; β and γ keep their start values. Range
/// rates of a sensor with a known unambiguous interval are compared modulo this interval.
class PublishedMethod : public Method {
 public:
  void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) final;
  /// The published methods have no covariance. Returned is that of Gauss–Newton: the inverse of the normal equations of
  /// the last minute with the variance of the residuals. It is too small: detections of a scan share the errors of the
  /// ego signals, angles are noisy, the model is not a rotation, and the step is not a Gauss–Newton step.
  [[nodiscard]] RadarEstimate estimate(std::size_t radar) const final;
  void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego, std::span<double> out) const final;

  /// The estimate with the covariance of estimate(); parameters that these methods do not estimate have a variance of
  /// 0.
  void save(Memory& memory) const final;
  /// Starts from the stored angles of radars with the same identity. The stored covariance is not used, because these
  /// methods do not weight by it.
  void restore(const Memory& memory, double away_s) final;
  /// Starts this radar from the angles of a static calibration. Their covariance counts in estimate() like that of one
  /// more scan and fades with the window, since the steps do not weight by it. A method of azimuth only refuses,
  /// because it has no pitch.
  bool seed(std::size_t radar, const Eigen::Vector3d& rotation_vehicle_rad, const Eigen::Matrix3d& covariance) final;

  /// (k_v, α_m, β_m, γ_m).
  [[nodiscard]] Eigen::Vector4d parameters(std::size_t radar) const;

 protected:
  /// `parameters`: 2 for a method of azimuth only, otherwise 4. `detections_per_scan`: number of drawn detections; 0:
  /// all.
  PublishedMethod(const VehicleConfig& vehicle, const PublishedConfig& config, int parameters,
                  std::size_t detections_per_scan);
  /// The increment of the estimate; entries beyond `scan.parameters` are ignored, and so is a step that is not finite.
  [[nodiscard]] virtual Eigen::Vector4d step(const ScanView& scan) = 0;

  [[nodiscard]] const PublishedConfig& config() const { return config_; }

 private:
  struct Radar {
    std::uint32_t id = 0;
    MountingPose nominal;
    double cycle_time_s = 0.05;
    Eigen::Vector3d angles = Eigen::Vector3d::Zero();  // α_m, β_m, γ_m
    AlignmentState state = AlignmentState::kNoData;
    std::int64_t last_used_ns = 0;
    bool used = false;
    bool has_elevation = false;
    double seconds_of_drive = 0.0;
    std::uint64_t scans_used = 0, detections_used = 0;
    // Decaying sums over the window:
    Eigen::Matrix4d jtj = Eigen::Matrix4d::Zero();
    Eigen::Vector4d jtr = Eigen::Vector4d::Zero();
    double rtr = 0.0, count = 0.0, offered = 0.0, believed = 0.0;
    Eigen::Matrix3d seeded = Eigen::Matrix3d::Zero();  // information of a calibration on the angles
  };
  [[nodiscard]] ScanView view(const Radar& radar, const ScanDetections& scan, const EgoSample& ego) const;
  [[nodiscard]] std::size_t select(const ScanView& scan);
  [[nodiscard]] std::size_t number_of_delivering(std::int64_t now_ns) const;
  [[nodiscard]] bool turn(Radar& radar, const Eigen::Vector3d& rotation_vehicle_rad) const;
  void move(Radar& radar, const ScanView& scan, const Eigen::Vector4d& step);

  PublishedConfig config_;
  int parameters_;
  std::size_t detections_per_scan_;
  double speed_scale_ = 1.0;
  std::vector<Radar> radars_;
  Draw draw_;
  std::array<std::uint16_t, kMaxDetections> selected_;
  std::array<double, kMaxDetections> residual_mps_;
  std::array<double, kMaxDetections> scratch_;
};

}  // namespace boresight::alignment::published
