// The estimator on drives of the world simulator, whose radars have a profile. Nothing is judged: there are no bars
// yet.
#include <algorithm>
#include <array>
#include <cmath>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/car/real_car.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/world_run.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

namespace {

/// Shipped scenarios in which the vehicle drives at 5 m/s or more nearly all the time.
constexpr const char* kWorldScenarios[] = {"demo_drive",       "city_canyon", "curve_with_rail",
                                           "truck_overtaking", "tunnel",      "straight_rail"};
/// Names of the figures, in the order of judge::kAlignmentParameters.
constexpr std::array<const char*, 4> kErrors = {"speed_scale.error", "rotation_x.error_deg", "rotation_y.error_deg",
                                                "rotation_z.error_deg"};
constexpr std::array<const char*, 4> kNees = {"speed_scale.nees", "rotation_x.nees", "rotation_y.nees",
                                              "rotation_z.nees"};
/// (Error / σ)² at the ends of a 95 % interval.
constexpr double kInterval95 = 1.96 * 1.96;
enum : std::size_t { kScaleAt, kRollAt, kPitchAt, kYawAt };

/// At the end of the drives, of all radars of all drives; only of axes that the estimator reports as observable.
struct WorldFigures {
  std::array<std::vector<double>, 4> errors, nees;
  double changes = 0.0, driven_s = 0.0;

  void take(const WorldRun& run) {
    for (std::size_t id = 1; id <= run.radars; ++id) {
      const std::string radar = "alignment.radar_" + std::to_string(id) + ".";
      for (std::size_t p = 0; p < errors.size(); ++p) {
        const double error = run.figures.value(radar + kErrors[p]), consistency = run.figures.value(radar + kNees[p]);
        if (!std::isfinite(error) || !std::isfinite(consistency)) continue;
        errors[p].push_back(std::abs(error));
        nees[p].push_back(consistency);
      }
    }
    changes += run.figures.value("alignment.false_step_changes");
    driven_s += run.duration_s;
  }
  void take(const WorldFigures& other) {
    for (std::size_t p = 0; p < errors.size(); ++p) {
      errors[p].insert(errors[p].end(), other.errors[p].begin(), other.errors[p].end());
      nees[p].insert(nees[p].end(), other.nees[p].begin(), other.nees[p].end());
    }
    changes += other.changes;
    driven_s += other.driven_s;
  }
  [[nodiscard]] std::string error(std::size_t p) const {
    return number(median(errors[p])) + " (" + number(quantile(errors[p], 0.95)) + ")";
  }
  [[nodiscard]] std::string mean_nees(std::size_t p) const {
    double sum = 0.0;
    for (const double value : nees[p]) sum += value;
    return nees[p].empty() ? "—" : number(sum / static_cast<double>(nees[p].size()));
  }
  /// Share of the radars whose true value lies in the stated 95 % interval, %.
  [[nodiscard]] std::string covered(std::size_t p) const {
    const auto inside = std::count_if(nees[p].begin(), nees[p].end(), [](double n) { return n <= kInterval95; });
    return nees[p].empty() ? "—" : fixed(100.0 * static_cast<double>(inside) / static_cast<double>(nees[p].size()), 0);
  }
  [[nodiscard]] std::vector<std::string> row(const std::string& name) const {
    return {name,
            error(kScaleAt),
            error(kYawAt),
            error(kPitchAt),
            mean_nees(kScaleAt),
            mean_nees(kYawAt),
            mean_nees(kPitchAt),
            mean_nees(kRollAt),
            covered(kScaleAt),
            covered(kYawAt),
            covered(kPitchAt),
            covered(kRollAt),
            fixed(changes, 0),
            number(changes / (driven_s / 3600.0))};
  }
};

}  // namespace

void world(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(8);
  const double longest_s = options.quick ? 4.0 : 45.0;
  Table table{
      "world",
      "errors of all radars at the end of drives in the world simulator, median (95 % quantile); mean NEES; share "
      "of radars within the stated 95 % interval. Only axes reported as observable count. False changes: step "
      "changes reported though none happened, and their number per hour. " +
          std::to_string(seeds) + " drives of at most " + fixed(longest_s, 0) + " s, seeds from " +
          std::to_string(options.first_seed) + " on.",
      {"scenario", "k_v", "yaw °", "pitch °", "NEES k_v", "NEES yaw", "NEES pitch", "NEES roll", "k_v within",
       "yaw within", "pitch within", "roll within", "false changes", "per hour"},
      {}};
  const simulator::car::RealCar car = options.real_car ? simulator::car::real_car_preset() : simulator::car::RealCar{};
  WorldFigures all;
  for (const char* scenario : kWorldScenarios) {
    std::vector<WorldRun> runs(seeds);
    parallel_for(seeds, options.jobs, [&](std::size_t i) {
      runs[i] = run_world_drive({scenario, options.profile, options.first_seed + i, longest_s, car});
    });
    WorldFigures of;
    for (const WorldRun& run : runs) of.take(run);
    table.rows.push_back(of.row(scenario));
    all.take(of);
    if (options.quick) break;
  }
  table.rows.push_back(all.row("**all**"));
  report.add(std::move(table));
}

}  // namespace boresight::bench
