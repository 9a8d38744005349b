// Settings of the alignment estimator; the defaults are what config/services/alignment_estimator.toml ships.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "services/alignment_estimator/core/published/config.hpp"

namespace boresight::alignment {

/// Estimators to choose from: Boresight's own, and those of the literature (Report A §8).
enum class MethodName : std::uint8_t { kBoresight, kSteepestDescent, kNls, kTls, kNelderMead, kAzimuth1d };

/// As they are called in configuration and on the command line.
inline constexpr std::array<std::pair<std::string_view, MethodName>, 6> kMethodNames{{
    {"boresight", MethodName::kBoresight},
    {"steepest_descent", MethodName::kSteepestDescent},
    {"nls", MethodName::kNls},
    {"tls", MethodName::kTls},
    {"nelder_mead", MethodName::kNelderMead},
    {"azimuth_1d", MethodName::kAzimuth1d},
}};

/// What a simulated drive knows of itself; added to the nominal angles.
struct Truth {
  struct Radar {
    std::uint32_t id = 0;
    double yaw_rad = 0.0;
    double pitch_rad = 0.0;
    double roll_rad = 0.0;
  };
  double speed_scale = 1.0;
  std::vector<Radar> radars;
};

struct Config {
  MethodName method = MethodName::kBoresight;
  published::PublishedConfig published;  ///< of all methods but kBoresight
  std::optional<Truth> truth;            ///< for the NEES
  double residual_gate_sigma = 4.0;      ///< key figures: residuals beyond this many stds are no inliers
  double min_speed_mps = 5.0;            ///< slower driving tells nothing (Report A §8)
  double prior_yaw_std_rad = 0.0698;     ///< 4°: how crooked a radar may be before anything was measured
  double prior_speed_scale_std = 0.03;
  double yaw_drift_rad_per_sqrt_s = 3e-6;  ///< random walk by which the mounting may change
  double speed_scale_drift_per_sqrt_s = 1e-5;
  double outlier_gate_sigma = 4.0;  ///< Tukey's constant: residuals beyond this many stds have no weight
  double start_gate_mps = 0.5;      ///< added to the std at the start and faded out, so that no wrong solution locks in
  double start_duration_s = 3.0;
  double ego_error_correlation_s = 0.2;    ///< how long an error of the speed or yaw-rate signal lasts
  double converged_yaw_std_rad = 0.00175;  ///< 0.1°
  double min_seconds_to_converge = 5.0;
  /// What pitch and roll errors, which this method does not model, do to yaw and k_v; added to the covariance.
  double systematic_yaw_std_rad = 3.5e-4;
  double systematic_speed_scale_std = 3e-4;
  double kpi_window_s = 20.0;
  double publish_period_s = 0.2;
};

}  // namespace boresight::alignment
