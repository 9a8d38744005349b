// The Cramér–Rao bound of a drive: the smallest variance that any unbiased alignment estimator can reach on it, given
// which detections are stationary.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/alignment/drive.hpp"

namespace boresight::simulator {

/// Prior standard deviations; 0: the parameter is known exactly.
struct BoundPriors {
  double speed_scale_std = 0.02;
  double rotation_std_rad = 3.0 * M_PI / 180.0;  ///< about each vehicle axis, for every radar
  double yaw_rate_bias_std_radps = 0.0;
  double slip_coefficient_std_radps2pm = 0.0;
  double min_speed_mps = 0.0;  ///< signalled; slower scans do not count, as estimators leave them out (Burza 2025, §8)
};

/// Sums the information of a drive's stationary detections at the truth, each with the variance
/// σ_ṙ² + (∂_α ṙ·σ_α)² + (∂_β ṙ·σ_β)² of its real noise. The errors of the speed and yaw-rate signals are eliminated
/// jointly for all scans that share an ego motion, body pitch as the time-correlated process that it is. Parameters in
/// the order of alignment::Memory: k_v, yaw-rate bias, slip coefficient, then of each radar the turn about the
/// vehicle's x, y and z axes.
///
/// Taken as known, so that the result stays a lower bound: the part of body pitch that acceleration causes. For radars
/// without elevation, roll and pitch keep their prior. Step changes of the mounting change the truth only.
class CramerRaoBound {
 public:
  static constexpr Eigen::Index kShared = 3;

  /// Throws std::invalid_argument for drives of the planar model, whose truth is no rotation. `drive` must outlive this
  /// object.
  CramerRaoBound(const AlignmentSpec& spec, const AlignmentDrive& drive, const BoundPriors& priors = {});

  /// Adds the next event of the drive, in order.
  void add(const AlignmentEvent& event);
  /// Square, 3 + 3 × radars rows.
  [[nodiscard]] Eigen::MatrixXd covariance() const;
  /// Standard deviations of a radar's rotation about the vehicle's x, y and z axes (rad).
  [[nodiscard]] Eigen::Vector3d rotation_std_rad(std::size_t radar) const;
  [[nodiscard]] double speed_scale_std() const;

 private:
  void eliminate(Eigen::MatrixXd& information, Eigen::Index variable) const;
  void renew_ego_errors();
  void advance_pitch(double time_s);

  AlignmentSpec spec_;
  const AlignmentDrive& drive_;
  Eigen::Index parameters_;
  std::vector<bool> known_;  ///< of the parameters
  double min_speed_mps_;
  double signalled_mps_ = 0.0;
  Eigen::MatrixXd information_;  ///< of the parameters, then the errors of speed and yaw rate, then body pitch
  double pitch_time_s_ = 0.0;
};

}  // namespace boresight::simulator
