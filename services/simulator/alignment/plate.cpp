#include "services/simulator/alignment/plate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace boresight::simulator {

namespace {

/// One-way gain relative to the lobe's middle, dB.
double gain_db(const PlateSpec& spec, double angle_rad) {
  const double x = angle_rad / spec.beam_width_rad;
  // One half, 10·log10(2) dB, at half the width.
  if (spec.lobe == PlateLobe::kGaussian) return -4.0 * 10.0 * std::log10(2.0) * x * x;
  // sin²(πu)/(πu)² falls to one half at u = 0.44295.
  const double u = M_PI * 2.0 * 0.44295 * x;
  const double sinc = std::abs(u) < 1e-9 ? 1.0 : std::sin(u) / u;
  return 20.0 * std::log10(std::max(std::abs(sinc), 1e-6));
}

double either_way(double value, std::mt19937_64& random) {
  return (random() & 1u) != 0 ? value : -value;
}

double between(double low, double high, std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

}  // namespace

double plate_amplitude_db(const PlateSpec& spec, double tilt_rad) {
  return spec.peak_db + 2.0 * gain_db(spec, -tilt_rad - spec.pitch_rad);
}

alignment::plate::Measurements simulate_plate(const PlateSpec& spec, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::array<std::size_t, alignment::plate::kMaxTilts> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(spec.number_of_tilts), random);

  alignment::plate::Measurements run;
  run.number_of_tilts = spec.number_of_tilts;
  for (std::size_t i = 0; i < spec.number_of_tilts; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(spec.number_of_tilts - 1);
    alignment::plate::TiltMeasurement& tilt = run.tilts[i];
    tilt.tilt_rad = spec.tilt_max_rad * (2.0 * share - 1.0);
    double amplitude_db = plate_amplitude_db(spec, tilt.tilt_rad) + spec.tilt_std_db * normal(random);
    double azimuth_rad = -spec.yaw_rad;
    const auto bad_end = order.begin() + static_cast<std::ptrdiff_t>(spec.bad_tilts);
    if (std::find(order.begin(), bad_end, i) != bad_end) {
      amplitude_db += either_way(between(spec.bad_tilt_min_db, spec.bad_tilt_max_db, random), random);
      azimuth_rad += either_way(spec.bad_tilt_azimuth_rad, random);
    }
    for (std::size_t k = 0; k < spec.scans_per_tilt; ++k) {
      double scan_db = amplitude_db + spec.amplitude_std_db * normal(random);
      double scan_rad = azimuth_rad + spec.azimuth_std_rad * normal(random);
      if (between(0.0, 1.0, random) < spec.bad_scan_share) {
        scan_db += between(spec.bad_scan_min_db, spec.bad_scan_max_db, random);
        scan_rad += between(-spec.bad_scan_azimuth_rad, spec.bad_scan_azimuth_rad, random);
      }
      tilt.add(scan_db, scan_rad);
    }
  }
  return run;
}

void fill_plate_scan(double amplitude_db, double azimuth_rad, std::int64_t measurement_time_ns, RadarScan& scan) {
  scan = {};
  scan.header.measurement_time_ns = measurement_time_ns;
  scan.fields = scan_field::kRcs;
  scan.number_of_valid_detections = 3;
  const std::array<double, 3> range_m{30.0, 4.0, 5.0}, azimuths_rad{0.01, azimuth_rad, 0.7};
  const std::array<double, 3> rcs_dbsm{amplitude_db + 10.0, amplitude_db, amplitude_db + 20.0};
  for (std::size_t i = 0; i < 3; ++i) {
    scan.range_m[i] = static_cast<float>(range_m[i]);
    scan.azimuth_rad[i] = static_cast<float>(azimuths_rad[i]);
    scan.rcs_dbsm[i] = static_cast<float>(rcs_dbsm[i]);
    scan.existence_probability[i] = 1.0F;
  }
}

}  // namespace boresight::simulator
