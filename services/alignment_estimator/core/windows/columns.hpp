// Parameters of the windowed estimator and their places in its vectors (docs/algorithms/alignment.md).
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace boresight::alignment::windows {

/// Knots of a radar's azimuth-error curve, evenly spaced over its field of view.
inline constexpr int kKnots = 11;

/// Parameters that a scan of one radar depends on.
namespace local {
enum : int {
  kSpeedScale,                   ///< k_v
  kRateScale,                    ///< e: the radar multiplies its range rates by 1 + e
  kRotation,                     ///< three: error of the rotation about the vehicle's x, y and z axes, Exp(d)·R
  kYawRateBias = kRotation + 3,  ///< rad/s
  kYawRateGain,                  ///< true = (signalled − bias)·(1 + gain)
  kSlip,                         ///< c of V_y = −c·V·(V·ω), rad per m/s²
  kStamp,                        ///< s; the motion that belongs to a scan is that at its stamp + this
  kPosition,                     ///< two: error of the position in the vehicle file, x and y (m)
  kPitchPerAcceleration = kPosition + 2,  ///< rad per m/s², positive with the nose up
  kCurve,                                 ///< kKnots: error of the azimuth, measured − true (rad)
  /// The road as a mirror: a reflector stands (1 + this) times as high above the road as its detection; and the share
  /// of the detections below the road that are mirror images of reflectors above it.
  kAbove = kCurve + kKnots,
  kMirror,
  kCount
};
}  // namespace local
using LocalVector = Eigen::Matrix<double, local::kCount, 1>;
using LocalMatrix = Eigen::Matrix<double, local::kCount, local::kCount>;

/// Parameters of a radar that no other radar shares.
namespace own {
enum : int {
  kRateScale,
  kRotation,
  kStamp = kRotation + 3,
  kPosition,
  kCurve = kPosition + 2,
  kAbove = kCurve + kKnots,
  kMirror,
  kPitchDrift,  ///< rad/s of the rotation about the vehicle's y and z axes, over the last minutes
  kYawDrift,
  kCount
};
}  // namespace own
using OwnVector = Eigen::Matrix<double, own::kCount, 1>;
using OwnMatrix = Eigen::Matrix<double, own::kCount, own::kCount>;

/// Parameters of the vehicle: constants, then steps of the load's pitch, then fluctuations of each segment.
namespace shared {
inline constexpr int kLoads = 3;
enum : int {
  kSpeedScale,
  kYawRateBias,
  kYawRateGain,
  kSlip,
  kPitchPerAcceleration,
  kStamp,
  kConstants,
  kLoad = kConstants,
  kFirstFluctuation = kLoad + kLoads
};
}  // namespace shared

/// Fluctuations: yaw, pitch and scale of the range rates, of one radar or of all.
inline constexpr int kFluctuations = 3;
/// Their columns among the local parameters.
inline constexpr std::array<int, kFluctuations> kFluctuating{local::kRotation + 2, local::kRotation + 1,
                                                             local::kRateScale};

/// Segments of driving time that are kept; the older, the longer.
inline constexpr int kMaxSegments = 40;
inline constexpr int kMaxShared = shared::kFirstFluctuation + kFluctuations * kMaxSegments;

}  // namespace boresight::alignment::windows
