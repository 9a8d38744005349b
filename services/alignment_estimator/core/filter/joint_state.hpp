// Mean and covariance of the parameters that all radars share and of each radar's rotation. A scan updates them by its
// measurement of one sensor's velocity: three numbers, however many detections.
// Equations: docs/algorithms/alignment.md (A16).
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "interfaces/messages/header.hpp"

namespace boresight::alignment {

/// Columns of the joint covariance that all radars share. The last four are errors of the motion at the instant of the
/// last scan; NuisanceModel holds their statistics.
namespace column {
inline constexpr Eigen::Index kSpeedScale = 0;
inline constexpr Eigen::Index kYawRateBias = 1;
inline constexpr Eigen::Index kSlip = 2;
inline constexpr Eigen::Index kPitchPerAcceleration = 3;
inline constexpr Eigen::Index kSpeed = 4;      ///< δV, true = signalled + δV, m/s
inline constexpr Eigen::Index kYawRate = 5;    ///< δω, rad/s
inline constexpr Eigen::Index kBodyPitch = 6;  ///< rad; adds V·θ upwards to the velocity
inline constexpr Eigen::Index kSideSlip = 7;   ///< rad; adds V·ψ to the left
inline constexpr Eigen::Index kShared = 8;
inline constexpr Eigen::Index kNuisances = kSpeed;
inline constexpr Eigen::Index kNumberOfNuisances = 4;
/// Columns of each radar:
/// - rotation about the vehicle's x, y, z (left error, Exp(d)·R);
/// - relative excess of the reduction of range rates by unknown elevations over the assumed one (1: twice as much);
/// - logarithm of the ratio of real to assumed variance of its angles. Noise of the angles looks like a spread of
/// angles,
///   and its share of the spread determines g.
inline constexpr Eigen::Index kPerRadar = 5;
inline constexpr Eigen::Index kElevations = 3, kAngleNoise = 4;
inline constexpr Eigen::Index kTouched = kShared + kPerRadar;
inline constexpr Eigen::Index kMax = kShared + kPerRadar * static_cast<Eigen::Index>(kMaxRadars);
[[nodiscard]] constexpr Eigen::Index of_radar(std::size_t radar) {
  return kShared + kPerRadar * static_cast<Eigen::Index>(radar);
}
}  // namespace column

/// ∂g/∂(column) of one scan: the shared columns, then the radar's five.
using VelocityGradient = Eigen::Matrix<double, column::kTouched, 3>;

class JointState {
 public:
  explicit JointState(std::size_t radars);

  double speed_scale = 1.0;
  double yaw_rate_bias_radps = 0.0;
  double slip_radps2pm = 0.0;
  double pitch_per_acceleration_radps2pm = 0.0;
  Eigen::Vector4d nuisances = Eigen::Vector4d::Zero();  ///< δV, δω, θ, ψ
  std::array<Eigen::Matrix3d, kMaxRadars> sensor_to_vehicle;
  /// Rotation at which a radar's derivatives are taken (first-estimates Jacobian). If it followed the estimate along an
  /// unobservable direction, the same information would seem to come from several directions.
  std::array<Eigen::Matrix3d, kMaxRadars> linearised;
  double linearised_speed_scale = 1.0;
  std::array<double, kMaxRadars> elevation_excess{};
  /// Assumed relative reduction of g by unmeasured elevations; 0 for radars that measure elevation.
  std::array<double, kMaxRadars> lowering{};
  std::array<double, kMaxRadars> log_angle_noise{};

  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] double covariance(Eigen::Index row, Eigen::Index column) const { return p_(row, column); }
  /// Covariance of a radar's rotation about the vehicle's axes, rad².
  [[nodiscard]] Eigen::Matrix3d rotation_covariance(std::size_t radar) const {
    const Eigen::Index first = column::of_radar(radar);
    return p_.block<3, 3>(first, first);
  }
  /// Sets a diagonal entry and clears the column's correlations.
  void set_variance(Eigen::Index index, double variance);
  void set_covariance(Eigen::Index row, Eigen::Index column, double value) {
    p_(row, column) = p_(column, row) = value;
  }
  void add_variance(Eigen::Index index, double variance) { p_(index, index) += variance; }
  /// Scales a column's correlations and sets its variance: an Ornstein–Uhlenbeck step.
  void decay(Eigen::Index index, double keep, double added_variance);
  /// Multiplies the whole covariance.
  void inflate(double factor) { p_ *= factor; }

  /// P·G over the touched columns, and the covariance Gᵀ·P·G of the sensor's velocity in its frame.
  void project(std::size_t radar, const VelocityGradient& gradient);
  [[nodiscard]] const Eigen::Matrix3d& velocity_covariance() const { return c_; }
  /// Updates with an information and a score of g, by the last projection. Returns false and changes nothing if the
  /// result would not be finite or not plausible.
  [[nodiscard]] bool update(const Eigen::Matrix3d& information, const Eigen::Vector3d& score);
  /// Applies external knowledge of one column: its mean moves by `shift`, its variance shrinks to `variance` at most,
  /// all other columns move by their correlation with it.
  void condition(Eigen::Index index, double shift, double variance);

  [[nodiscard]] bool finite() const { return p_.allFinite(); }

 private:
  void move(const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, column::kMax, 1>& step);

  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, column::kMax, column::kMax>;
  using Projection = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, column::kMax, 3>;
  std::size_t radars_;
  Eigen::Index size_;
  Covariance p_;
  Projection pg_, pgx_;
  Eigen::Matrix3d c_;
};

}  // namespace boresight::alignment
