// Simulated radar data of a tilting plate at an end-of-line station (Burza 2025, §7), with known truth.
//
// Physics: a flat plate larger than the beam's footprint returns the ray at normal incidence. At tilt τ (positive =
// toward the ground) this ray has elevation −τ. It lies at −τ − β_m in the antenna's elevation lobe and passes the lobe
// twice, out and back: the amplitude in dB is peak + 2·G(−τ − β_m). Near the maximum this is a parabola: exactly for a
// Gaussian lobe, nearly for the lobe of a uniform aperture (sinc²).
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "interfaces/messages/radar_scan.hpp"
#include "services/alignment_estimator/core/plate/measurement.hpp"

namespace boresight::simulator {

enum class PlateLobe : std::uint8_t { kGaussian, kSinc };

struct PlateSpec {
  std::size_t number_of_tilts = 11;
  double tilt_max_rad = 0.08727;  ///< tilts evenly from −5° to +5°
  std::size_t scans_per_tilt = 30;
  double yaw_rad = 0.0;    ///< truth α_m, + boresight turned left
  double pitch_rad = 0.0;  ///< truth β_m, + boresight looks up
  PlateLobe lobe = PlateLobe::kGaussian;
  double beam_width_rad = 0.192;  ///< 11°: one way, between the half-power points
  double peak_db = 20.0;
  double amplitude_std_db = 1.2;     ///< per scan
  double tilt_std_db = 0.1;          ///< per tilt, common to its scans: effect of the floor and the plate's drive
  double azimuth_std_rad = 0.00436;  ///< 0.25°, per scan
  /// Tilts disturbed as a whole by an object in the beam: amplitude and azimuth shift up or down.
  std::size_t bad_tilts = 0;
  double bad_tilt_min_db = 2.0, bad_tilt_max_db = 5.0;
  double bad_tilt_azimuth_rad = 0.00698;  ///< 0.4°, with either sign
  /// Scans disturbed one by one: mostly by fading, sometimes by an echo that adds power.
  double bad_scan_share = 0.0;
  double bad_scan_min_db = -10.0, bad_scan_max_db = 3.0;
  double bad_scan_azimuth_rad = 0.0698;  ///< 4°: uniform within ± this
};

/// Simulates one run with random numbers from `random`.
[[nodiscard]] alignment::plate::Measurements simulate_plate(const PlateSpec& spec, std::mt19937_64& random);

/// Amplitude without noise at a tilt, dB.
[[nodiscard]] double plate_amplitude_db(const PlateSpec& spec, double tilt_rad);

/// Writes a whole scan with the plate at 4 m, a stronger wall at 30 m, and a stronger post at 5 m and an azimuth of
/// 40°. Optional fields: RCS.
void fill_plate_scan(double amplitude_db, double azimuth_rad, std::int64_t measurement_time_ns, RadarScan& scan);

}  // namespace boresight::simulator
