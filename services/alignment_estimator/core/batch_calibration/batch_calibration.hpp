// Calibration of a recording after the fact, without measured elevation (Burza 2025, §9;
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
  double elevation_rad = 0.0;   ///< means something only if Recording::has_elevation
  double range_rate_mps = 0.0;  ///< not aliased: what may be is to be left out by the caller
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// What one radar saw; detections of all scans in a row.
struct Recording {
  MountingPose nominal;
  bool has_elevation = false;
  std::vector<Detection> detections;
};

struct Config {
  double elevation_low_rad = -0.02;               ///< missing elevations are drawn from here … (29)
  double elevation_high_rad = 0.06;               ///< … to here
  double start_speed_scale = 1.0;                 ///< (30)
  double start_pitch_rad = 0.026179938779914943;  ///< 1.5° (30); yaw and roll start at 0
  double speed_scale_cost = 0.1;                  ///< of (31)
  std::size_t detections_per_iteration = 256;     ///< of each radar
  double rate = 1e-4;                             ///< η
  std::size_t iterations = 60'000;                ///< not published: six times the time constant 1/η
  std::uint64_t seed = 1;
  double min_speed_mps = 5.0;
  /// Ours: RadarScenes says which detections move with the world, other recordings do not. Detections further than
  /// this many robust stds from the median residual, found in rounds with the estimate of k_v and yaw that a robust
  /// fit gives, are left out. 0: none.
  double gate_sigma = 4.0;
  double gate_floor_mps = 0.1;
  std::size_t min_detections = 128;  ///< of a radar in the whole recording: with fewer it does not take part
  std::size_t history_every = 100;   ///< iterations between two entries of the history
  /// For the judgement of what the data support (ours): how many draws of the missing elevations are solved to the end,
  /// over how many detections of each radar; by how much their mean (rad) and their tilt (rad per rad of azimuth) are
  /// moved, how many times as wide they are drawn, how much roll may be there that nobody measured; and what counts as
  /// supported.
  std::size_t judgement_draws = 8;
  std::size_t judgement_detections = 20'000;
  double judgement_shift_rad = 0.035;  ///< 2°, as the errors of Burza's simulation
  double judgement_width = 2.0;
  double judgement_roll_rad = 0.035;
  double prior_angle_std_rad = 0.0698;  ///< 4°: no std is larger
  double believable_speed_scale = 2e-3;
  double believable_angle_rad = 0.0052;  ///< 0.3°
};

/// Why a parameter is not to be believed.
enum class Support : std::uint8_t {
  kSupported,
  kFollowsFillIn,  ///< changes with how the elevations were made up
  kSpreads,        ///< changes with the draw of the elevations that were made up
  kUncertain,      ///< the information matrix leaves it open
  kNoData,
};

struct Parameter {
  double value = 0.0;
  /// From the information matrix and the residuals' variance, with missing elevations at their mean: the draws feign
  /// information (they make a roll look like noise, which is then found to be 0).
  double std = 0.0;
  double spread = 0.0;  ///< std over fill-ins, each solved to the end
  /// Change by moving the mean of the made-up elevations, over that move, or by tilting them along the azimuth, over
  /// that tilt, whichever is larger: −1 says that the parameter is minus what was made up, and no measurement.
  double response = 0.0;
  /// By how much the parameter changes if what was made up had been made up otherwise: the root of the sum of squares
  /// over another mean, tilt and width of the elevations, and another roll. No std tells of it.
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
  Residuals before, after;  ///< of the used, m/s; before: k_v = 1 and no correction
};

/// Parameters at one iteration: k_v, then α, β, γ of each radar; cost (31) of its detections.
struct Step {
  std::size_t iteration = 0;
  double cost = 0.0;
  std::vector<double> parameters;
};

struct Result {
  bool ok = false;
  std::string problem;  ///< why not ok
  Parameter speed_scale;
  std::vector<RadarResult> radars;
  Residuals before, after;  ///< of all
  Residuals yaw_only;       ///< with k_v and yaw only, pitch, roll and missing elevations 0: what the rest is worth
  std::vector<Step> history;
};

/// What a calibration does one after the other.
enum class Phase : std::uint8_t {
  kGate,       ///< finds what stands still
  kIteration,  ///< the published one, most of the time
  kJudgement,  ///< what the data support
};
/// Hears how much of a phase is done, 0 … 1 and not falling, some hundred times in all.
using Progress = std::function<void(Phase phase, double share)>;

/// All radars together for one k_v and per-radar α, β, γ, by nonlinear total least squares. Same input and seed, same
/// output. For offline tools: allocates and takes seconds. What the data support is judged within the planar model of
/// Burza 2025, which is no rotation: where elevation is measured, it lets pitch and roll seem better known than they
/// are (docs/algorithms/published-alignment.md).
[[nodiscard]] Result calibrate(std::span<const Recording> radars, const Config& config = {},
                               const Progress& progress = {});

/// One word or two: "supported", "follows the made-up elevation", …
[[nodiscard]] const char* to_text(Support support);

}  // namespace boresight::alignment::batch_calibration
