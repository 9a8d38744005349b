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

/// Why the state is what it is, the first that applies.
enum class AlignmentReason : std::uint8_t {
  kNone = 0,               ///< converged, and nothing contradicts it
  kWrongInput = 1,         ///< see AlignmentEstimate::finding
  kNoEgoMotion = 2,        ///< no valid speed and yaw rate at the time of the scans
  kTooSlow = 3,            ///< below the speed from which scans are used
  kTooFewDetections = 4,   ///< in the scans
  kNoConsistentStart = 5,  ///< no mounting within the prior explains the range rates
  kFewInliers = 6,         ///< the share of stationary detections is implausibly small
  kLargeResidual = 7,      ///< residuals of the inliers exceed the stated noise by far
  kNotObservable = 8,      ///< the drive does not determine the yaw
  kLargeStd = 9,           ///< the standard deviation is still above the configured one
  kShortDrive = 10,        ///< not enough driving time yet
};

/// A wrong input that explains the data better than any mounting error.
enum class AlignmentFinding : std::uint8_t {
  kNone = 0,
  kRadarsSwapped = 1,      ///< this radar's detections fit the mounting of `finding_radar`, and the other way round
  kOtherRadar = 2,         ///< the detections are those of `finding_radar`
  kNominalYawWrong = 3,    ///< the nominal yaw is wrong by `finding_value` (rad)
  kAzimuthMirrored = 4,    ///< sign of the azimuths
  kRangeRateMirrored = 5,  ///< sign of the range rates
  kYawRateMirrored = 6,    ///< sign of the yaw rate
  kAzimuthOrYawRate = 7,   ///< one of the two signs; the data of a single radar cannot tell which
  kSpeedUnit = 8,          ///< the speed signal is `finding_value` times the speed in m/s: 3.6 km/h, 2.237 mph
  kYawRateUnit = 9,        ///< the yaw-rate signal is `finding_value` times that in rad/s: 57.3 °/s
  kSpeedFrozen = 10,       ///< the speed signal does not follow the range rates
  kSpeedZero = 11,         ///< it is zero although the vehicle moves
  kEgoMotionMissing = 12,  ///< no valid speed or yaw rate although the radar sees motion
  kCopiedDetections = 13,  ///< scans consist of copies of one detection
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

/// A change that all radars share.
struct AlignmentVehicleChange {
  std::int64_t time_ns;  ///< measurement time at which it was reported; 0: never
  float size;            ///< estimated
  std::uint32_t count;   ///< since the start of the service
};
static_assert(sizeof(AlignmentVehicleChange) == 16);

/// Slow change of one radar's mounting, over the last minutes.
struct AlignmentDrift {
  std::int64_t since_ns;  ///< measurement time from which it has been reported; 0: it is not
  float yaw_radps;
  float yaw_std_radps;
  float pitch_radps;
  float pitch_std_radps;
};
static_assert(sizeof(AlignmentDrift) == 24);

struct AlignmentValue {
  float value;
  float std;  ///< 0: not estimated
};

/// Bits of `AlignmentNuisance::observable`: the standard deviation is less than half of the prior's.
namespace alignment_nuisance {
inline constexpr std::uint32_t kRangeRateScale = 1u << 0;
inline constexpr std::uint32_t kTimeOffset = 1u << 1;
inline constexpr std::uint32_t kPositionX = 1u << 2;
inline constexpr std::uint32_t kPositionY = 1u << 3;
inline constexpr std::uint32_t kAzimuthCurve = 1u << 4;
inline constexpr std::uint32_t kYawRateGain = 1u << 5;
inline constexpr std::uint32_t kPitchPerAcceleration = 1u << 6;
inline constexpr std::uint32_t kLoadPitch = 1u << 7;
inline constexpr std::uint32_t kYawRateBias = 1u << 8;
inline constexpr std::uint32_t kSlip = 1u << 9;
}  // namespace alignment_nuisance

inline constexpr std::size_t kAzimuthCurveKnots = 11;

/// What else the estimator learns of a radar and of the vehicle.
struct AlignmentNuisance {
  AlignmentValue range_rate_scale;                 ///< e: the radar multiplies its range rates by 1 + e
  AlignmentValue time_offset_s;                    ///< the ego motion of a scan is that at its stamp + this
  AlignmentValue position_x_m;                     ///< actual − nominal position, vehicle axes
  AlignmentValue position_y_m;                     //
  AlignmentValue yaw_rate_gain;                    ///< true yaw rate = (signalled − bias)·(1 + this)
  AlignmentValue pitch_per_acceleration_radps2pm;  ///< rad per m/s², positive with the nose up
  AlignmentValue load_pitch_rad;                   ///< of the body since the estimate began, positive with the nose up
  float yaw_scatter_rad;                           ///< learnt std of the radar's yaw between windows of some seconds
  float pitch_scatter_rad;                         //
  /// Measured − true azimuth at `azimuth_curve_first_rad` + i·`azimuth_curve_step_rad`; zero mean, so that it is no
  /// yaw.
  std::array<float, kAzimuthCurveKnots> azimuth_curve_rad;
  std::array<float, kAzimuthCurveKnots> azimuth_curve_std_rad;
  float azimuth_curve_first_rad;
  float azimuth_curve_step_rad;  ///< 0: no curve
  std::uint32_t observable;      ///< alignment_nuisance bits
  float range_rate_noise_scale;  ///< factor on the stds of range rates that explains the residuals; 0: not estimated
};
static_assert(sizeof(AlignmentNuisance) == 168);

/// Mounting correction of the radar `header.source_id`, in two forms of the same rotation.
/// Sensor form: actual mounting = nominal + correction, R(sensor→vehicle) = R_z(α_b+α_m)·R_y(−(β_b+β_m))·R_x(γ_b+γ_m),
/// α yaw, β pitch (positive looks up), γ roll. Vehicle form: R(actual) = R_x(roll)·R_y(−pitch)·R_z(yaw)·R(nominal), a
/// rotation about the vehicle's axes, z first and x last, so that an unknown roll does not affect yaw and pitch. A
/// positive pitch turns a forward-looking radar up.
struct AlignmentEstimate {
  static constexpr std::uint32_t kVersion = 4;

  MessageHeader header;
  AlignmentState state;
  AlignmentReason reason;
  AlignmentFinding finding;
  std::uint8_t reserved;
  std::uint32_t observable;     ///< alignment_axis bits
  float finding_value;          ///< see AlignmentFinding
  std::uint32_t finding_radar;  ///< id; 0: none
  /// k_v as this radar sees it: a stationary reflector's range rates are those of k_v · signalled speed. It contains
  /// the radar's own scale of range rates; true speed = k_v / (1 + range_rate_scale) · signalled speed.
  float speed_scale;
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
  AlignmentVehicleChange load_change;   ///< of the load: size in rad of the body's pitch, positive with the nose up
  AlignmentVehicleChange speed_change;  ///< of the speed signal: new scale / old scale − 1
  AlignmentDrift drift;
  AlignmentNuisance nuisance;
  AlignmentKpis kpis;

  [[nodiscard]] bool is_observable(std::uint32_t axis_bits) const { return (observable & axis_bits) == axis_bits; }
};

static_assert(kIsPlainMessage<AlignmentEstimate>);
static_assert(sizeof(AlignmentEstimate) == 656);

}  // namespace boresight
