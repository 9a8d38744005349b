// Batch calibration of a recording without measured elevation (Burza 2025, §9;
// docs/algorithms/batch-calibration.md (29)–(32)).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::batch_calibration {

/// One detection with the signalled motion of its instant (at the rear axle, without k_v).
struct Detection {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;   ///< valid only if Recording::has_elevation
  double range_rate_mps = 0.0;  ///< not aliased: the caller must exclude detections that may be
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// The detections of one radar, all scans in a row.
struct Recording {
  MountingPose nominal;
  bool has_elevation = false;
  std::vector<Detection> detections;
};

struct Config {
  double elevation_low_rad = -0.02;               ///< lower limit of drawn elevations (29)
  double elevation_high_rad = 0.06;               ///< upper limit
  double start_speed_scale = 1.0;                 ///< (30)
  double start_pitch_rad = 0.026179938779914943;  ///< 1.5° (30); yaw and roll start at 0
  double speed_scale_cost = 0.1;                  ///< of (31)
  std::size_t detections_per_iteration = 256;     ///< of each radar
  double rate = 1e-4;                             ///< η
  std::size_t iterations = 60'000;                ///< not published: six time constants 1/η
  std::uint64_t seed = 1;
  double min_speed_mps = 5.0;
  /// Ours: RadarScenes labels stationary detections, other recordings do not. Rejects detections further than this many
  /// robust stds from the median residual of a robust fit of k_v and yaw, in several rounds. 0: no gate.
  double gate_sigma = 4.0;
  double gate_floor_mps = 0.1;
  std::size_t min_detections = 128;  ///< of a radar in the whole recording: with fewer it is not used
  std::size_t history_every = 100;   ///< iterations between two entries of the history
  /// Settings of the judgement (ours): number of draws of the missing elevations, number of detections per radar, shift
  /// of the mean (rad), tilt (rad per rad of azimuth), factor of the width, unmeasured roll, and the limits below which
  /// a parameter is supported.
  std::size_t judgement_draws = 8;
  std::size_t judgement_detections = 20'000;
  double judgement_shift_rad = 0.035;  ///< 2°, like the errors of Burza's simulation
  double judgement_width = 2.0;
  double judgement_roll_rad = 0.035;
  double prior_angle_std_rad = 0.0698;  ///< 4°: no std is larger
  double supported_speed_scale = 2e-3;
  double supported_angle_rad = 0.0052;  ///< 0.3°
};

/// Whether the data support a parameter, or why not.
enum class Support : std::uint8_t {
  kSupported,
  kFollowsFillIn,  ///< changes with the assumed distribution of elevations
  kSpreads,        ///< changes with the draw of the assumed elevations
  kUncertain,      ///< its std is too large
  kNoData,
};

struct Parameter {
  double value = 0.0;
  /// From the information matrix and the variance of the residuals, with missing elevations at their mean. Drawn
  /// elevations would add false information: they make a roll look like noise, and the result is a roll of 0.
  double std = 0.0;
  double spread = 0.0;  ///< std over draws, each solved completely
  /// Change of the parameter over the change of the assumed elevations: by a shift of their mean, or by a tilt along
  /// the azimuth, whichever is larger. −1: the parameter is minus the assumed value and not a measurement.
  double response = 0.0;
  /// Change of the parameter under other assumptions: root of the sum of squares over another mean, tilt and width of
  /// the elevations, and another roll. The std does not include it.
  double made_up = 0.0;
  Support support = Support::kNoData;
};

struct Residuals {
  std::size_t count = 0;
  double rmse_mps = 0.0, skewness = 0.0, kurtosis = 0.0;
};

struct RadarResult {
  Parameter yaw, pitch, roll;  ///< α_m, β_m, γ_m, added to the nominal angles, rad
  std::size_t offered = 0, used = 0;
  Residuals before, after;  ///< of the used detections, m/s; before: k_v = 1 and no correction
};

/// Parameters at one iteration: k_v, then α, β, γ of each radar; cost (31) of its detections.
struct Step {
  std::size_t iteration = 0;
  double cost = 0.0;
  std::vector<double> parameters;
};

struct Result {
  bool ok = false;
  std::string problem;  ///< reason, if not ok
  Parameter speed_scale;
  std::vector<RadarResult> radars;
  Residuals before, after;  ///< of all radars
  Residuals yaw_only;       ///< with k_v and yaw only; pitch, roll and missing elevations 0
  std::vector<Step> history;
};

/// The successive phases of a calibration.
enum class Phase : std::uint8_t {
  kGate,       ///< finds the stationary detections
  kIteration,  ///< the published iteration, most of the time
  kJudgement,  ///< which parameters the data support
};
/// Receives the completed share of a phase, 0 … 1 and never decreasing, some hundred times in all.
using Progress = std::function<void(Phase phase, double share)>;

/// Calibrates all radars together by nonlinear total least squares: one k_v, and α, β, γ per radar. Same input and seed
/// give the same output. For offline tools: it allocates and takes seconds. The judgement uses the planar model of
/// Burza 2025, which is not a rotation. With measured elevation, pitch and roll therefore seem better known than they
/// are (docs/algorithms/published-alignment.md).
[[nodiscard]] Result calibrate(std::span<const Recording> radars, const Config& config = {},
                               const Progress& progress = {});

/// A few words, such as "supported" or "not supported: too uncertain".
[[nodiscard]] const char* to_text(Support support);

}  // namespace boresight::alignment::batch_calibration
