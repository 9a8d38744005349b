// The estimate that is kept over ignition cycles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/header.hpp"
#include "services/alignment_estimator/core/windows/columns.hpp"

namespace boresight::alignment {

/// State of the vehicle's alignment. Each radar has a covariance of its own, and the vehicle's parameters have one:
/// their correlations are lost, so whoever writes a memory enlarges the covariances accordingly. A variance of zero:
/// the method does not estimate this parameter.
struct Memory {
  /// A radar's own parameters but the drift, in the order of windows::own; the vehicle's in that of windows::shared.
  static constexpr std::size_t kOwn = windows::own::kPitchDrift;
  static constexpr std::size_t kShared = windows::shared::kConstants;
  static constexpr std::size_t kRotation = windows::own::kRotation;
  static constexpr std::size_t kSpeedScale = windows::shared::kSpeedScale;
  static constexpr std::size_t kYawRateBias = windows::shared::kYawRateBias;
  static constexpr std::size_t kSlip = windows::shared::kSlip;

  struct Radar {
    std::uint32_t id = 0;
    bool has_elevation = true;                     ///< its scans measured elevations
    std::array<double, 3> rotation_vehicle_rad{};  ///< vector d of R(actual) = Exp(d)·R(nominal)
    double range_rate_scale = 0.0;                 ///< error of the radar's own scale
    double time_offset_s = 0.0;
    std::array<double, 2> position_error_m{};  ///< x and y
    std::array<double, windows::kKnots> azimuth_curve_rad{};
    double height_excess = 0.0;
    double mirror_share = 0.0;
    double angle_noise_scale = 1.0;       ///< of the angles' stds
    double range_rate_noise_scale = 1.0;  ///< of the range rates' stds
    double seconds_of_drive = 0.0;
    /// Variances of this radar's fluctuations of yaw, pitch (rad²) and scale; 0: not learnt.
    std::array<double, windows::kFluctuations> fluctuation_variance{};
    std::array<double, kOwn * kOwn> covariance{};  ///< row-major

    [[nodiscard]] double& variance(std::size_t row, std::size_t column) { return covariance[row * kOwn + column]; }
    [[nodiscard]] double variance(std::size_t row, std::size_t column) const { return covariance[row * kOwn + column]; }
    [[nodiscard]] double& rotation_variance(std::size_t row, std::size_t column) {
      return variance(kRotation + row, kRotation + column);
    }
    [[nodiscard]] double rotation_variance(std::size_t row, std::size_t column) const {
      return variance(kRotation + row, kRotation + column);
    }
  };

  std::size_t number_of_radars = 0;
  /// When it was written: the machine's boot (0: not known), and the time since then. Written by whoever stores it.
  std::uint64_t boot = 0;
  std::int64_t since_boot_ns = 0;
  double speed_scale = 1.0;
  double yaw_rate_bias_radps = 0.0;
  double yaw_rate_gain = 0.0;
  double slip_coefficient_radps2pm = 0.0;
  double pitch_per_acceleration_radps2pm = 0.0;
  double time_offset_s = 0.0;   ///< the part that all radars share
  double load_pitch_rad = 0.0;  ///< pitch of the body by all changes of the load so far
  /// Of the fluctuations of yaw, pitch (rad²) and scale that all radars share; 0: not learnt. Their correlation times.
  std::array<double, windows::kFluctuations> fluctuation_variance{};
  std::array<double, windows::kFluctuations> correlation_s{};
  std::array<double, kShared * kShared> covariance{};  ///< row-major
  std::array<Radar, kMaxRadars> radars{};

  [[nodiscard]] double& variance(std::size_t row, std::size_t column) { return covariance[row * kShared + column]; }
  [[nodiscard]] double variance(std::size_t row, std::size_t column) const {
    return covariance[row * kShared + column];
  }
};

}  // namespace boresight::alignment
