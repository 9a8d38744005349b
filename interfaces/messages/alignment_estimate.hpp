// The alignment estimator's result for one radar: mounting error, speed-scale error and their covariance.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

/// Progress of one radar's estimate.
enum class AlignmentState : std::uint8_t {
  kNoData = 0,      ///< no usable data received yet
  kWaiting = 1,     ///< data arrive, but the vehicle is too slow or the scene does not support an estimate
  kConverging = 2,  ///< estimating; the standard deviation is still above the configured one
  kConverged = 3,
};

/// Index of a parameter in the estimate's vectors and covariance.
enum class AlignmentParameter : std::uint8_t { kSpeedScale = 0, kYaw = 1, kPitch = 2, kRoll = 3 };
inline constexpr std::size_t kNumberOfAlignmentParameters = 4;

/// Bits of `AlignmentEstimate::observable`: the quantities that the data determine. The others are NOT OBSERVABLE and
/// hold the prior's values. For a side-looking radar, the pitch about the vehicle's axis can be observable although
/// neither pitch nor roll about its own axes is. Both triples therefore have their bits.
namespace alignment_axis {
inline constexpr std::uint32_t kSpeedScale = 1u << 0;
inline constexpr std::uint32_t kYaw = 1u << 1;  ///< about the sensor's axes (α, β, γ)
inline constexpr std::uint32_t kPitch = 1u << 2;
inline constexpr std::uint32_t kRoll = 1u << 3;
inline constexpr std::uint32_t kVehicleYaw = 1u << 4;  ///< about the vehicle's axes
inline constexpr std::uint32_t kVehiclePitch = 1u << 5;
inline constexpr std::uint32_t kVehicleRoll = 1u << 6;
inline constexpr std::uint32_t kYawRateBias = 1u << 7;
inline constexpr std::uint32_t kSlip = 1u << 8;
}  // namespace alignment_axis

/// Key figures (Burza 2025, §8). Unknown values are NaN, unknown counts 0.
struct AlignmentKpis {
  float residual_rmse_mps;  ///< root mean square of the inliers' corrected range-rate residual, sliding window
  float uncorrected_residual_rmse_mps;  ///< the same with k_v = 1 and no correction
  float residual_skewness;
  float residual_kurtosis;                     ///< 3 for a Gaussian
  float inlier_ratio;                          ///< 0…1
  float seconds_of_drive;                      ///< time with estimation: fast enough, data present
  std::array<float, 4> seconds_to_95_percent;  ///< drive time until 95 % of the change from the start to today's value;
                                               ///< k_v, then yaw, pitch, roll about the vehicle's axes
  std::array<std::uint32_t, 4> scans_to_95_percent;  ///< the same as a number of this radar's scans; 0: unknown
  std::array<float, 4> drift_per_minute;             ///< change over the last minute of drive: 1/min, then rad/min
  float nees;  ///< normalised estimation error squared, over the observable of these four, divided by their
               ///< number; 1 if the covariance is consistent with the error. NaN unless the configuration has
               ///< the true values (simulated drives)
  std::uint32_t reserved;
  std::uint64_t scans_used;
  std::uint64_t detections_used;
};
static_assert(sizeof(AlignmentKpis) == 96);

/// A sudden change of one radar's mounting.
struct AlignmentStepChange {
  std::int64_t time_ns;                       ///< measurement time at which the change was reported; 0: never
  std::array<float, 3> rotation_vehicle_rad;  ///< estimated rotation about the vehicle's x, y, z axes (right-handed)
  std::uint32_t count;                        ///< since the start of the service
};
static_assert(sizeof(AlignmentStepChange) == 24);

/// Mounting correction of the radar `header.source_id`, in two forms of the same rotation.
/// Sensor form: actual mounting = nominal + correction, R(sensor→vehicle) = R_z(α_b+α_m)·R_y(−(β_b+β_m))·R_x(γ_b+γ_m),
/// α yaw, β pitch (positive looks up), γ roll. Vehicle form: R(actual) = R_x(roll)·R_y(−pitch)·R_z(yaw)·R(nominal), a
/// rotation about the vehicle's axes, z first and x last, so that an unknown roll does not affect yaw and pitch. A
/// positive pitch turns a forward-looking radar up.
struct AlignmentEstimate {
  static constexpr std::uint32_t kVersion = 2;

  MessageHeader header;
  AlignmentState state;
  std::array<std::uint8_t, 3> reserved;
  std::uint32_t observable;  ///< alignment_axis bits
  float speed_scale;         ///< k_v: true speed = k_v · signalled speed
  float alignment_yaw_rad;
  float alignment_pitch_rad;
  float alignment_roll_rad;
  float vehicle_yaw_rad;
  float vehicle_pitch_rad;
  float vehicle_roll_rad;
  float yaw_rate_bias_radps;  ///< signalled = true + bias
  float yaw_rate_bias_std_radps;
  float slip_coefficient_radps2pm;  ///< c of V_y = −c·V·(V·ω), rad per m/s²
  float slip_coefficient_std_radps2pm;
  float angle_noise_scale;  ///< factor on the sensor's angle standard deviations that explains the residuals
  /// Row-major 4 × 4 over (k_v, yaw, pitch, roll), units 1 and rad; rows of unobservable axes hold the prior.
  alignas(16) std::array<float, 16> covariance;
  std::array<float, 16> vehicle_covariance;  ///< the same over (k_v, vehicle yaw, pitch, roll)
  AlignmentStepChange step_change;
  AlignmentKpis kpis;

  [[nodiscard]] bool is_observable(std::uint32_t axis_bits) const { return (observable & axis_bits) == axis_bits; }
};

static_assert(kIsPlainMessage<AlignmentEstimate>);
static_assert(sizeof(AlignmentEstimate) == 416);

}  // namespace boresight
