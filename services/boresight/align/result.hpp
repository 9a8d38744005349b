// The result of `boresight align` as values; JSON, plot and table are made from it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/boresight/align/residuals.hpp"

namespace boresight::align {

/// Order of the four parameters everywhere: k_v, then yaw, pitch, roll (rad) about the vehicle's axes.
inline constexpr std::size_t kParameters = 4;

/// Estimates at one instant.
struct Sample {
  struct Radar {
    AlignmentState state = AlignmentState::kNoData;
    std::uint32_t observable = 0;  ///< alignment_axis bits
    std::array<double, kParameters> values{}, stds{};
  };
  double x = 0.0;  ///< time of the recording in s, or the iteration
  double speed_scale = 1.0, speed_scale_std = 0.0;
  double yaw_rate_bias_radps = 0.0, yaw_rate_bias_std_radps = 0.0;
  double slip_coefficient_radps2pm = 0.0, slip_coefficient_std_radps2pm = 0.0;
  std::vector<Radar> radars;
};

struct StepChangeEvent {
  double time_s = 0.0;
  std::array<double, 3> yaw_pitch_roll_rad{};  ///< of the rotation, about the vehicle's axes
};

/// A change that all radars share.
struct VehicleChangeEvent {
  double time_s = 0.0;  ///< at which it was reported
  double size = 0.0;    ///< of the load: rad of the body's pitch, positive with the nose up; of the speed signal: 1
};

/// Errors are estimate − truth; angle errors are those of the remaining rotation, R(estimate) = Exp(e)·R(truth), about
/// the vehicle's axes. The NEES (normalised estimation error squared) is error²/variance.
struct TruthComparison {
  /// A true mounting from some time on; several if the mounting changed in a step.
  struct Mounting {
    double from_s = 0.0;  ///< −∞ for the first
    Eigen::Matrix3d sensor_to_vehicle;
    std::array<double, kParameters> values{};  ///< as in Sample; k_v is NaN if unknown
  };
  std::vector<Mounting> mountings;
  std::size_t true_now = 0;  ///< index of the mounting at the end
  std::array<double, kParameters> errors{}, nees{};
  std::array<double, 3> sensor_errors_rad{};  ///< of α, β, γ
  /// Seconds of drive until the value stayed within 5 % of the change from nominal to truth. After a step change they
  /// count from the step, and the change from the truth before it. NaN: never.
  std::array<double, kParameters> seconds_to_95_percent{};
};

/// Mounting before a sudden misalignment; as in Sample.
struct MountingBefore {
  std::array<double, kParameters> values{}, stds{};
};

struct RadarResult {
  std::uint32_t id = 0;
  std::string name;
  bool measures_elevation = false;
  alignment::RadarEstimate estimate;
  AlignmentEstimate message{};             ///< as the service publishes it, without header
  std::array<double, kParameters> stds{};  ///< of k_v and the message's vehicle yaw, pitch, roll
  std::uint64_t scans = 0, scans_without_ego = 0, detections = 0;
  ResidualSummary residuals;
  double cpu_us_per_scan = 0.0, max_cpu_us_per_scan = 0.0;  ///< NaN if no scan was processed on its own
  std::vector<StepChangeEvent> step_changes;
  std::string reason;          ///< why the state is what it is, in words; "" if there is nothing to say
  std::string finding;         ///< sentence of a wrong input; "" without one
  double drift_since_s = 0.0;  ///< on the recording's clock; NaN: no drift is reported
  /// batch: before the first sudden misalignment, if there was enough driving before it.
  std::optional<MountingBefore> before_change;
  /// batch_calibration: for α, β, γ "supported", or why the data do not support the parameter.
  std::vector<std::string> support;
  std::optional<TruthComparison> truth;
};

struct Result {
  std::string method;
  std::string vehicle;
  double start_s = 0.0, end_s = 0.0;  ///< of scans, on the recording's clock; NaN without any
  double ego_start_s = 0.0, ego_end_s = 0.0;
  std::uint64_t scans = 0, detections = 0, ego_motions = 0;
  double speed_scale = 1.0, speed_scale_std = 0.0;
  bool speed_scale_observable = false;
  std::optional<double> true_speed_scale, true_yaw_rate_bias_radps, true_slip_coefficient_radps2pm;
  std::string problem;              ///< why there is no result; "" if there is one
  std::string speed_scale_support;  ///< batch_calibration, as RadarResult::support
  std::vector<RadarResult> radars;
  std::vector<VehicleChangeEvent> load_changes, speed_changes;
  AlignmentNuisance vehicle_nuisance{};  ///< of the radar that knows the vehicle's parameters best
  /// batch: driving time, windows not included in turn, and how often the recording was read.
  struct Batch {
    double driven_s = 0.0;
    int windows = 0, passes = 0;
    bool settled = false;  ///< the last pass changed nothing that matters
  };
  std::optional<Batch> batch;
  bool x_is_iteration = false;
  std::vector<Sample> series;
};

}  // namespace boresight::align
