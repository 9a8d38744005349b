// Static calibration with the tilting plate: error of each evaluation method.
#include "services/simulator/alignment/plate_table.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"

namespace boresight::bench {

void plate(const Options& options, Report& report) {
  const std::size_t runs = options.quick ? 50 : 2000;
  Table table{"plate",
              "tilting plate: RMSE in degrees over " + std::to_string(runs) + " runs",
              {"", "elevation: weighted least squares (published)", "median of triples", "robust (ours)",
               "azimuth: two rounds of 2σ (published)", "3 MAD (ours)", "NEES elevation / azimuth (ours)",
               "failed runs published / ours"},
              {}};
  for (const simulator::PlateSetting& setting : simulator::plate_settings()) {
    const simulator::PlateRow row = simulator::plate_errors(setting.spec, runs, 1);
    const std::string name(setting.name);
    table.rows.push_back({name, fixed(row.published_pitch_deg, 3), fixed(row.triples_pitch_deg, 3),
                          fixed(row.robust_pitch_deg, 3), fixed(row.published_yaw_deg, 4), fixed(row.robust_yaw_deg, 4),
                          fixed(row.robust_pitch_nees, 2) + " / " + fixed(row.robust_yaw_nees, 2),
                          std::to_string(row.published_failed) + " / " + std::to_string(row.robust_failed)});
    if (setting.spec.bad_tilts == 0) continue;
    const std::string how = "RMSE over " + std::to_string(runs) + " runs, truth drawn within ±2°";
    report.at_most("plate", "elevation, " + name, row.robust_pitch_deg, setting.spec.bad_tilts == 1 ? 0.12 : 0.20, "°",
                   how);
    report.at_most("plate", "azimuth, " + name, row.robust_yaw_deg, 0.02, "°", how);
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
