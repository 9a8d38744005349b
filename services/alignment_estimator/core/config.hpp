// Settings of the alignment estimator; the defaults equal config/services/alignment_estimator.toml.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/plausibility/config.hpp"
#include "services/alignment_estimator/core/published/config.hpp"
#include "services/alignment_estimator/core/windows/config.hpp"
#include "services/common/vehicle/drive_truth.hpp"

namespace boresight::alignment {

/// The available estimators: Boresight's own, and those of Burza 2025, §8.
enum class MethodName : std::uint8_t {
  kBoresight,
  kSteepestDescent,
  kNls,
  kTls,
  kNelderMead,
  kAzimuth1d,
  kBoresightPlanar
};

/// Their names in the configuration and on the command line.
inline constexpr std::array<std::pair<std::string_view, MethodName>, 7> kMethodNames{{
    {"boresight", MethodName::kBoresight},
    {"steepest_descent", MethodName::kSteepestDescent},
    {"nls", MethodName::kNls},
    {"tls", MethodName::kTls},
    {"nelder_mead", MethodName::kNelderMead},
    {"azimuth_1d", MethodName::kAzimuth1d},
    // Boresight's filter with the planar roll model of Burza 2025; it only reproduces the published tables.
    {"boresight_planar", MethodName::kBoresightPlanar},
}};

struct Config {
  MethodName method = MethodName::kBoresight;
  FilterConfig filter;                   ///< settings of kBoresight
  windows::WindowsConfig windows;        ///< of its windows
  published::PublishedConfig published;  ///< settings of all other methods
  PlausibilityConfig plausibility;       ///< search for wrong inputs, beside every method
  double publish_period_s = 0.2;
  double kpi_window_s = 20.0;        ///< time constant of the residual statistics
  double residual_gate_sigma = 4.0;  ///< key figures: detections with larger residuals (in stds) are no inliers
  std::optional<DriveTruth> truth;   ///< of simulated drives, for the NEES

  /// Std of the mounting error before any measurement, as the chosen method assumes it.
  [[nodiscard]] double prior_angle_std_rad() const {
    return method == MethodName::kBoresight ? windows.priors.rotation_std_rad : published.prior_angle_std_rad;
  }
  /// Scans at lower speed are not used.
  [[nodiscard]] double min_speed_mps() const {
    return method == MethodName::kBoresight ? filter.min_speed_mps : published.min_speed_mps;
  }
};

}  // namespace boresight::alignment
