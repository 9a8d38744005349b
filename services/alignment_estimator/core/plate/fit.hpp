// From the plate's measurements to the mounting error: the published fit and the product's own.
// Equations: docs/algorithms/plate.md (1)–(9) and (P1)–(P5).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "services/alignment_estimator/core/plate/measurement.hpp"

namespace boresight::alignment::plate {

enum class FitMethod : std::uint8_t {
  /// Each tilt's median in dB, refined by Tukey's biweight; RANSAC and least squares; azimuth by a mean within 3 MAD.
  kRobust,
  /// Burza 2025, §7: weighted least squares of means (2)–(8); azimuth by two rounds of 2σ (9).
  kPublished,
};

/// Why a run failed.
enum class Failure : std::uint8_t {
  kNone,
  kAborted,              ///< by the station
  kPositioningTimeout,   ///< the plate was not reported in place
  kNoPlateSeen,          ///< no usable detection of the plate for too long
  kMeasuringTimeout,     ///< too few scans of the plate in time
  kDecisionTimeout,      ///< the station did not go on after a tilt
  kTooFewTilts,          ///< too few tilts for a fit, or too few that agree with one another
  kTooFewScans,          ///< a tilt with fewer than kMinScansPerTilt
  kTiltsNotMonotonic,    ///< tilts neither increase nor decrease throughout
  kNotFinite,            ///< a measured value is not a number
  kNoMaximum,            ///< b₁ ≥ 0: the amplitude has no maximum over the tilt
  kMaximumOutsideTilts,  ///< beyond the measured tilts: an extrapolation
  kAmplitudeTooLow,      ///< at its maximum (8) below the limit: the bumper transmits too little
};
[[nodiscard]] std::string_view name_of(Failure failure);
/// A sentence for log and display, without a full stop.
[[nodiscard]] std::string_view explain(Failure failure);

struct FitConfig {
  FitMethod method = FitMethod::kRobust;
  /// Number of tilts that must be measured, and that must agree in the robust fit.
  std::size_t min_tilts = 5;
  double min_amplitude_db = -100.0;  ///< of the fitted maximum (8); in the unit of the amplitudes
  std::size_t triples = 100;         ///< M random triples for the self-consistency; 1…kMaxTriples
  std::uint64_t seed = 1;            ///< of their choice: the same measurements give the same result
  double consistency_rad = 0.00524;  ///< 0.3°: a triple this close to the result agrees with it
  double model_std_db = 0.1;         ///< deviation of a real lobe from a parabola, added to each median's std
};
inline constexpr std::size_t kMaxTriples = 500;

/// Result of one tilt.
struct TiltSummary {
  double tilt_rad = 0.0;
  std::size_t scans = 0;
  double mean_db = 0.0, std_db = 0.0, median_db = 0.0;
  double mean_azimuth_rad = 0.0, azimuth_std_rad = 0.0;
  double taken_db = 0.0;  ///< amplitude used by the fit
  double fitted_db = 0.0;
  bool used = false;  ///< by the fit; the robust fit rejects tilts that contradict the others
};

/// All computed values are filled in, even if `failure` makes them unusable. Angles in radians.
struct PlateResult {
  Failure failure = Failure::kNone;
  FitMethod method = FitMethod::kRobust;
  /// Mounting error in the sensor's own angles: α_m = −ᾱ (9), positive = boresight turned left; β_m = −β* (7),
  /// positive = boresight looks up. For a radar whose nominal roll is not 0, see seed.hpp.
  double yaw_rad = 0.0, yaw_std_rad = 0.0;
  double pitch_rad = 0.0, pitch_std_rad = 0.0;
  double maximum_db = 0.0;            ///< A(−b₂/2b₁) (8)
  std::array<double, 3> parabola{};   ///< b₁ (dB/rad²), b₂ (dB/rad), b₃ (dB) of (2)
  double triples_median_rad = 0.0;    ///< median of β_m over the random triples
  double triples_std_rad = 0.0;       ///< their spread; the published std of β_m
  double self_consistency = 0.0;      ///< share of the triples that agree with β_m, 0…1
  double azimuth_inlier_ratio = 0.0;  ///< share of all scans whose azimuth was used
  std::size_t number_of_tilts = 0;
  std::size_t tilts_used = 0;
  std::array<TiltSummary, kMaxTilts> tilts{};

  [[nodiscard]] bool ok() const { return failure == Failure::kNone; }
};

/// Never allocates; never throws. `failure` is set for an unusable run.
[[nodiscard]] PlateResult evaluate(const Measurements& measurements, const FitConfig& config);

}  // namespace boresight::alignment::plate
