// Errors of the evaluation methods of a plate run: the settings of the benchmark, and Monte-Carlo runs over them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "services/alignment_estimator/core/plate/fit.hpp"
#include "services/simulator/alignment/plate.hpp"

namespace boresight::simulator {

struct PlateSetting {
  std::string_view name;
  PlateSpec spec;
};

/// The three settings of the benchmark.
[[nodiscard]] inline std::array<PlateSetting, 3> plate_settings() {
  std::array<PlateSetting, 3> settings{
      {{"clean", {}}, {"one bad tilt, 5 % bad scans", {}}, {"two bad tilts, 20 % bad scans", {}}}};
  settings[1].spec.bad_tilts = 1;
  settings[1].spec.bad_scan_share = 0.05;
  settings[2].spec.bad_tilts = 2;
  settings[2].spec.bad_scan_share = 0.2;
  return settings;
}

/// RMSE over the runs in degrees. NEES (normalised estimation error squared): mean of (error / std)², which is 1 if the
/// stated std is right.
struct PlateRow {
  std::size_t runs = 0;
  std::size_t published_failed = 0, robust_failed = 0;  ///< runs without a result, not part of the RMSE
  double published_pitch_deg = 0.0;                     ///< weighted least squares
  double triples_pitch_deg = 0.0;                       ///< median of the random triples' maxima
  double robust_pitch_deg = 0.0;                        ///< RANSAC and least squares on medians
  double published_yaw_deg = 0.0;                       ///< two rounds of 2σ
  double robust_yaw_deg = 0.0;                          ///< within 3 MAD
  double robust_pitch_nees = 0.0, robust_yaw_nees = 0.0;
};

/// Runs the evaluation with pitch and yaw drawn uniformly within ±2° for each run.
[[nodiscard]] inline PlateRow plate_errors(PlateSpec spec, std::size_t runs, std::uint64_t seed) {
  namespace plate = alignment::plate;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> truth(-2.0 * M_PI / 180.0, 2.0 * M_PI / 180.0);
  PlateRow row{.runs = runs};
  const auto add = [](double& sum, double error_rad) { sum += std::pow(error_rad * 180.0 / M_PI, 2.0); };
  for (std::size_t run = 0; run < runs; ++run) {
    spec.pitch_rad = truth(random);
    spec.yaw_rad = truth(random);
    const plate::Measurements measurements = simulate_plate(spec, random);
    plate::FitConfig config{.method = plate::FitMethod::kPublished, .seed = run};
    const plate::PlateResult published = plate::evaluate(measurements, config);
    config.method = plate::FitMethod::kRobust;
    const plate::PlateResult robust = plate::evaluate(measurements, config);
    if (published.ok()) {
      add(row.published_pitch_deg, published.pitch_rad - spec.pitch_rad);
      add(row.triples_pitch_deg, published.triples_median_rad - spec.pitch_rad);
      add(row.published_yaw_deg, published.yaw_rad - spec.yaw_rad);
    } else {
      ++row.published_failed;
    }
    if (robust.ok()) {
      const double pitch_error = robust.pitch_rad - spec.pitch_rad, yaw_error = robust.yaw_rad - spec.yaw_rad;
      add(row.robust_pitch_deg, pitch_error);
      add(row.robust_yaw_deg, yaw_error);
      row.robust_pitch_nees += std::pow(pitch_error / robust.pitch_std_rad, 2.0);
      row.robust_yaw_nees += std::pow(yaw_error / robust.yaw_std_rad, 2.0);
    } else {
      ++row.robust_failed;
    }
  }
  const double published = static_cast<double>(runs - row.published_failed);
  const double robust = static_cast<double>(runs - row.robust_failed);
  for (double* sum : {&row.published_pitch_deg, &row.triples_pitch_deg, &row.published_yaw_deg}) {
    *sum = std::sqrt(*sum / published);
  }
  for (double* sum : {&row.robust_pitch_deg, &row.robust_yaw_deg}) *sum = std::sqrt(*sum / robust);
  row.robust_pitch_nees /= robust;
  row.robust_yaw_nees /= robust;
  return row;
}

}  // namespace boresight::simulator
