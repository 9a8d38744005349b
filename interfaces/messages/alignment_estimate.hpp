// What the alignment estimator believes about one radar: how crooked it is, how wrong the speed signal is, how sure.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

/// How far the estimate of one radar has come.
enum class AlignmentState : std::uint8_t {
  kNoData = 0,      ///< nothing usable received yet
  kWaiting = 1,     ///< data arrive but the vehicle is too slow or the scene does not support an estimate
  kConverging = 2,  ///< estimating; the standard deviation is still above the configured one
  kConverged = 3,
};

/// Index of a parameter in the estimate's vectors and covariance.
enum class AlignmentParameter : std::uint8_t { kSpeedScale = 0, kYaw = 1, kPitch = 2, kRoll = 3 };
inline constexpr std::size_t kNumberOfAlignmentParameters = 4;

/// Bits of `AlignmentEstimate::observable`: which axes the data support at all.
namespace alignment_axis {
inline constexpr std::uint32_t kSpeedScale = 1u << 0;
inline constexpr std::uint32_t kYaw = 1u << 1;
inline constexpr std::uint32_t kPitch = 1u << 2;
inline constexpr std::uint32_t kRoll = 1u << 3;
}  // namespace alignment_axis

/// Key figures of the corrected range-rate residual over the estimator's sliding window (Report A §8).
struct AlignmentKpis {
  float residual_rmse_mps;
  float uncorrected_residual_rmse_mps;  ///< the same with k_v = 1 and no correction
  float residual_skewness;
  float residual_kurtosis;  ///< 3 for a Gaussian
  float inlier_ratio;       ///< 0…1
  float seconds_of_drive;   ///< time spent estimating (fast enough, data present)
  std::uint64_t scans_used;
  std::uint64_t detections_used;
};
static_assert(sizeof(AlignmentKpis) == 40);

/// Mounting correction of the radar `header.source_id`: actual mounting = nominal + correction, rotation
/// R(sensor→vehicle) = R_z(α_b+α_m)·R_y(−(β_b+β_m))·R_x(γ_b+γ_m), α yaw, β pitch (positive looks up), γ roll.
struct AlignmentEstimate {
  static constexpr std::uint32_t kVersion = 1;

  MessageHeader header;
  AlignmentState state;
  std::array<std::uint8_t, 3> reserved;
  std::uint32_t observable;  ///< alignment_axis bits
  float speed_scale;         ///< k_v: true speed = k_v · signalled speed
  float alignment_yaw_rad;
  float alignment_pitch_rad;
  float alignment_roll_rad;
  /// Row-major 4 × 4 over (k_v, yaw, pitch, roll), units 1 and rad; rows of unobservable axes hold the prior.
  alignas(16) std::array<float, 16> covariance;
  AlignmentKpis kpis;

  [[nodiscard]] bool is_observable(std::uint32_t axis_bits) const { return (observable & axis_bits) == axis_bits; }
};

static_assert(kIsPlainMessage<AlignmentEstimate>);
static_assert(sizeof(AlignmentEstimate) == 240);

}  // namespace boresight
