// Boresight's filter with the planar roll model of Burza 2025; it only reproduces the published tables.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/planar/config.hpp"
#include "services/alignment_estimator/core/planar/planar_start.hpp"
#include "services/alignment_estimator/core/planar/planar_sums.hpp"
#include "services/alignment_estimator/core/planar/support.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::planar {

/// A robust recursive information filter like RobustFilter, for data that follow (10)–(12) instead of a rotation: one
/// k_v, and α, β, γ of each radar. Errors of the speed and yaw-rate signals are white over time and shared by scans of
/// the same instant. It has no detector of step changes, no memory and no estimate of the angles' noise. It starts by a
/// search and refuses the result of a calibration.
class PlanarFilter : public Method {
 public:
  PlanarFilter(const VehicleConfig& vehicle, const PlanarConfig& config);

  void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) override;
  [[nodiscard]] RadarEstimate estimate(std::size_t radar) const override;
  void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego,
               std::span<double> out) const override;

  /// (k_v, α_m, β_m, γ_m) and their covariance.
  [[nodiscard]] Eigen::Vector4d parameters(std::size_t radar) const;
  [[nodiscard]] Eigen::Matrix4d covariance(std::size_t radar) const;

 private:
  // Columns of the joint covariance: k_v, δV and δω of this instant, then α, β, γ of each radar.
  static constexpr Eigen::Index kSpeedScaleColumn = 0, kSpeedColumn = 1, kYawRateColumn = 2;
  static constexpr Eigen::Index kShared = 3;
  static constexpr Eigen::Index kMaxSize = kShared + 3 * static_cast<Eigen::Index>(kMaxRadars);
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxSize, 1>;
  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSize, kMaxSize>;
  using Gain = Eigen::Matrix<double, Eigen::Dynamic, 5, 0, kMaxSize, 5>;

  struct Radar {
    MountingPose nominal;
    double cycle_time_s = 0.05;
    PlanarStart start;
    Support support;
    bool running = false, has_elevation = false;
    AlignmentState state = AlignmentState::kNoData;
    std::int64_t last_time_ns = 0;
    double seconds_of_drive = 0.0;
    double slope = 0.0, square = 0.0;  ///< sliding E[ψ′] and E[ψ²]
    double inlier_ratio = 0.0;         ///< sliding
    int strange_scans = 0, scans_to_renewal = 0;
    std::uint64_t scans_used = 0, detections_used = 0;
    Radar(const RadarConfig& radar, const PlanarConfig& config);
  };
  [[nodiscard]] static Eigen::Index column_of(std::size_t radar) {
    return kShared + 3 * static_cast<Eigen::Index>(radar);
  }
  void advance(std::int64_t time_ns, const EgoSample& ego);
  void set_variance(Eigen::Index column, double variance);
  [[nodiscard]] Parameters local(std::size_t radar, double speed_mps) const;
  [[nodiscard]] Gain gain_columns(std::size_t radar, double speed_mps) const;
  [[nodiscard]] Square local_covariance(const Gain& columns, std::size_t radar, double speed_mps) const;
  void search(std::size_t radar, const ScanDetections& scan, const Setting& setting, double elapsed_s);
  void update(std::size_t radar, const ScanDetections& scan, const Setting& setting, double elapsed_s);
  void take(std::size_t radar, double speed_mps, const Square& information, const Parameters& score);
  void reopen(std::size_t radar);

  PlanarConfig config_;
  double speed_std_mps_, yaw_rate_std_radps_;  ///< used if the ego signals state none
  std::vector<Radar> radars_;
  State state_;
  Covariance covariance_;
  std::int64_t instant_ns_ = 0;
  bool has_instant_ = false;
};

}  // namespace boresight::alignment::planar
