// Calibration of a recording after the fact, without measured elevation (Report A §9; algorithms.md §1.1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::post_factum {

/// One detection with the signalled motion of its instant (at the rear axle, without k_v).
struct Detection {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;  ///< means something only if Recording::has_elevation
  double range_rate_mps = 0.0;
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
  std::size_t iterations = 60'000;                ///< not published: six times what 95 % takes at this η
  std::uint64_t seed = 1;
  double min_speed_mps = 5.0;
  /// Ours: RadarScenes says which detections move with the world, other recordings do not. Detections further than
  /// this many robust stds from the median residual, found in rounds with the estimate of k_v and yaw that a robust
  /// fit gives, are left out. 0: none.
  double gate_sigma = 4.0;
  double gate_floor_mps = 0.1;
  std::size_t history_every = 100;  ///< iterations between two entries of the history
  /// For the judgement of what the data support: how many fill-ins are solved to the end, and by how much their mean
  /// is shifted.
  std::size_t judgement_seeds = 8;
  double judgement_shift_rad = 0.01;
};

/// Why a parameter is not to be believed.
enum class Support : std::uint8_t {
  kSupported,
  kFollowsFillIn,  ///< changes with the mean of the elevations that were made up
  kSpreads,        ///< changes with the draw of the elevations that were made up
  kUncertain,      ///< the information matrix leaves it open
  kNoData,
};

struct Parameter {
  double value = 0.0;
  double std = 0.0;     ///< from the information matrix and the residuals' variance; ±∞ where singular
  double spread = 0.0;  ///< std over fill-ins, each solved to the end
  double response =
      0.0;  ///< change by a shift of the fill-in's mean, over that shift; −1: minus the mean (rad per rad)
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
  std::vector<Step> history;
};

/// All radars together for one k_v and per-radar α, β, γ, by nonlinear total least squares. Same input and seed, same
/// output. For offline tools: allocates and takes seconds.
[[nodiscard]] Result calibrate(std::span<const Recording> radars, const Config& config = {});

/// One word or two: "supported", "follows the made-up elevation", …
[[nodiscard]] const char* to_text(Support support);

}  // namespace boresight::alignment::post_factum
