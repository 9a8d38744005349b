// One method on one simulated drive, compared with the truth.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/method.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/alignment/spec.hpp"
#include "tests/benchmarks/alignment/common/moments.hpp"
#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

using MakeMethod = std::function<std::unique_ptr<alignment::Method>(const VehicleConfig&)>;

/// Errors are estimate − truth: of k_v, and the rotation vector of R_est·R_trueᵀ in vehicle axes (x roll, y pitch, z
/// yaw), in this order wherever there are four. The true k_v is what an estimator sees through this radar: with the
/// radar's own scale of range rates. The true mounting is that on the body, without the pitch of the body by load.
struct RadarError {
  Eigen::Vector4d error = Eigen::Vector4d::Zero();             ///< 1, rad
  Eigen::Vector4d std = Eigen::Vector4d::Zero();               ///< as the method states them
  Eigen::Vector3d sensor_error_rad = Eigen::Vector3d::Zero();  ///< of α, β, γ
  std::uint32_t observable = 0;
  AlignmentState state = AlignmentState::kNoData;
};

inline constexpr std::array<const char*, 4> kParameters = {"k_v", "roll", "pitch", "yaw"};
inline constexpr std::array<std::uint32_t, 4> kParameterBits = {
    alignment_axis::kSpeedScale, alignment_axis::kVehicleRoll, alignment_axis::kVehiclePitch,
    alignment_axis::kVehicleYaw};
enum : int { kSpeedScale = 0, kRoll = 1, kPitch = 2, kYaw = 3 };

struct Snapshot {
  double time_s = 0.0;           ///< since the first message
  double driven_s = 0.0;         ///< part of it at 5 m/s or more
  std::uint64_t iterations = 0;  ///< scans of radar 0 until then
  std::vector<RadarError> radars;
};

struct StepChangeSeen {
  std::size_t radar = 0;
  double time_s = 0.0;  ///< when it could first be read, since the first message
};

struct Run {
  std::vector<Snapshot> snapshots;  ///< the first is before any data
  Moments corrected, uncorrected;   ///< residuals of stationary detections in the last fifth of the drive
  std::vector<StepChangeSeen> step_changes;
  std::uint64_t scans = 0;  ///< of all radars

  [[nodiscard]] const Snapshot& last() const { return snapshots.back(); }
};

struct RunOptions {
  double snapshot_period_s = 1.0;
  double fine_period_s = 0.1;    ///< in the first 12 s
  bool only_stationary = false;  ///< true inliers: all other detections are marked invalid
  bool residuals = false;        ///< fill Run::corrected and uncorrected
  bool false_changes = false;    ///< fill Run::step_changes also on drives without a step change
  /// Called with each snapshot; for data that only one method has.
  std::function<void(const alignment::Method&, double time_s)> look;
};

[[nodiscard]] Run run_drive(const simulator::AlignmentSpec& spec, const MakeMethod& make,
                            const RunOptions& options = {});

/// Seconds of driving and iterations until 95 % of the initial error is removed, against truth. `first` is the first
/// time at which the error of the parameter is 5 % of the initial one or less; from `stays` on it stays so. Infinite if
/// never. NaN if the initial error is less than `least` (1 or rad), too small for this measure.
struct TimeTo95 {
  double first_s, stays_s;
  double first_iterations;
};
[[nodiscard]] TimeTo95 time_to_95(const Run& run, std::size_t radar, int parameter, double least);
/// The same of α (0), β (1), γ (2).
[[nodiscard]] TimeTo95 time_to_95_sensor(const Run& run, std::size_t radar, int angle, double least);

}  // namespace boresight::bench
