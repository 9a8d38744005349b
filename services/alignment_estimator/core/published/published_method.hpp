// What the published methods have in common: from a scan to the sums over its detections, and the book-keeping.
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

/// The scan that a method takes its step from.
struct ScanView {
  const MountingPose& nominal;
  const ScanDetections& detections;
  double speed_mps;
  double yaw_rate_radps;                    ///< 0 for the straight-road model
  int parameters;                           ///< of (k_v, α, β, γ) the first so many are estimated: 2 or 4
  Eigen::Vector4d b;                        ///< the estimate before the step
  std::span<const std::uint16_t> selected;  ///< indices of the detections to use
  NormalEquations equations;                ///< over these, at b; gradients of parameters held are 0

  [[nodiscard]] PlanarModel model(const Eigen::Vector4d& at) const { return {nominal, at, speed_mps, yaw_rate_radps}; }
  /// Model − measured, m/s; the nearest one if the sensor's range rates are ambiguous.
  [[nodiscard]] double residual(double model_mps, std::size_t detection) const {
    const double r = model_mps - detections.range_rate_mps[detection];
    return detections.ambiguity_mps > 0.0 ? std::remainder(r, detections.ambiguity_mps) : r;
  }
};

/// Every radar has its angles, all share k_v. Burza 2025 steps all radars at once, with the mean of their steps of k_v;
/// here scans come one radar at a time, and each moves k_v by its own step divided by the number of radars that
/// currently deliver. For synchronised radars that is the same but for terms of second order in the step.
///
/// A radar without elevation has it taken as 0, and only k_v and α are estimated; β and γ stay as they started. Range
/// rates of a sensor with a known unambiguous interval are compared modulo it.
class PublishedMethod : public Method {
 public:
  void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) final;
  /// The published methods know no covariance. Given is that of Gauss–Newton: the inverse of the normal equations of
  /// the last minute with the variance of the residuals. It is not honest: detections of a scan share the errors of the
  /// ego signals, angles are noisy, the model is not a rotation, and the step is not a Gauss–Newton step.
  [[nodiscard]] RadarEstimate estimate(std::size_t radar) const final;
  void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego, std::span<double> out) const final;

  /// The estimate with the covariance of estimate(); what these methods do not estimate has a variance of 0.
  void save(Memory& memory) const final;
  /// Starts from what was remembered of the radars whose identity is the same. The covariance starts anew: these
  /// methods weight nothing by it.
  void restore(const Memory& memory) final;
  /// Starts this radar from the calibration's angles; its covariance stands for the estimate as one more scan would and
  /// is forgotten with the window, since the next steps weight nothing by it. Refused by a method of azimuth only,
  /// which cannot hold the pitch that was measured.
  bool seed(std::size_t radar, const Eigen::Vector3d& rotation_vehicle_rad, const Eigen::Matrix3d& covariance) final;

  /// (k_v, α_m, β_m, γ_m).
  [[nodiscard]] Eigen::Vector4d parameters(std::size_t radar) const;

 protected:
  /// `parameters`: 2 for a method of azimuth only, else 4. `detections_per_scan`: drawn among the usable; 0: all.
  PublishedMethod(const VehicleConfig& vehicle, const PublishedConfig& config, int parameters,
                  std::size_t detections_per_scan);
  /// What to add to the estimate; entries beyond `scan.parameters` are ignored. A step that is not finite is not taken.
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
    // Over the window, faded:
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
