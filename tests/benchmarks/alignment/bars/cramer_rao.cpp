// Errors over the Cramér–Rao bound of the same drive: no unbiased estimator can get below a ratio of 1.
#include <cmath>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/windows/priors.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/simulator/alignment/bound.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

/// Prior knowledge of the bound, equal to the estimator's: bias and slip are unknown, scans below 5 m/s are not used.
/// A drive may begin in a corner below that speed, which would hold most of its information about roll.
constexpr alignment::FilterConfig kFilter;
constexpr alignment::windows::Priors kKnown;
constexpr simulator::BoundPriors kPriors{.speed_scale_std = kKnown.speed_scale_std,
                                         .rotation_std_rad = 4.0 * kRadiansPerDegree,
                                         .yaw_rate_bias_std_radps = 0.2 * kRadiansPerDegree,
                                         .slip_coefficient_std_radps2pm = kKnown.slip_std_radps2pm,
                                         .min_speed_mps = kFilter.min_speed_mps};

/// Stds in the order of RadarError::error, by radar.
std::vector<Eigen::Vector4d> bound_of(const simulator::AlignmentSpec& spec) {
  simulator::AlignmentDrive drive(spec);
  simulator::CramerRaoBound bound(spec, drive, kPriors);
  simulator::AlignmentEvent event;
  while (drive.next(event)) bound.add(event);
  std::vector<Eigen::Vector4d> stds;
  for (std::size_t r = 0; r < spec.radars.size(); ++r) {
    Eigen::Vector4d std;
    std << bound.speed_scale_std(), bound.rotation_std_rad(r);
    stds.push_back(std);
  }
  return stds;
}

}  // namespace

void cramer_rao(const Options& options, Report& report) {
  using simulator::RoadKind;
  const std::size_t seeds = options.seeds(40);
  Table table{"cramer_rao",
              "root mean square of error / bound over " + std::to_string(seeds) +
                  " clean drives of 120 s × 4 radars; in the bound's rows its median std",
              {"road", "detections", "k_v", "yaw", "pitch", "roll"},
              {}};
  double worst_oracle = 0.0, worst_robust = 0.0;
  std::string worst_oracle_where, worst_robust_where;
  for (const RoadKind road : {RoadKind::kCity, RoadKind::kMotorway, RoadKind::kMixed}) {
    std::vector<simulator::AlignmentSpec> specs;
    for (std::size_t seed = 0; seed < seeds; ++seed) {
      specs.push_back(clean_drive(road, options.seconds(120.0), 4000 + seed));
    }
    std::vector<std::vector<Eigen::Vector4d>> bounds(specs.size());
    parallel_for(specs.size(), options.jobs, [&](std::size_t i) { bounds[i] = bound_of(specs[i]); });
    std::vector<std::string> bound_row = {name_of(road), "*bound*"};
    for (const int parameter : {kSpeedScale, kYaw, kPitch, kRoll}) {
      std::vector<double> stds;
      for (const auto& radars : bounds) {
        for (const auto& std : radars) stds.push_back(std(parameter));
      }
      const bool is_angle = parameter != kSpeedScale;
      bound_row.push_back(number(median(stds) / (is_angle ? kRadiansPerDegree : 1.0)) + (is_angle ? "°" : ""));
    }
    table.rows.push_back(bound_row);
    for (const bool oracle : {true, false}) {
      RunOptions run_options;
      run_options.only_stationary = oracle;
      const auto runs = run_drives(specs, own_method(options.method).make, options, run_options);
      std::vector<std::string> row = {name_of(road), oracle ? "stationary only" : "all, robust"};
      for (const int parameter : {kSpeedScale, kYaw, kPitch, kRoll}) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < runs.size(); ++i) {
          for (std::size_t r = 0; r < bounds[i].size(); ++r) {
            ratios.push_back(runs[i].last().radars[r].error(parameter) / bounds[i][r](parameter));
          }
        }
        const double ratio = root_mean_square(ratios);
        row.push_back(fixed(ratio, 2));
        double& worst = oracle ? worst_oracle : worst_robust;
        if (ratio <= worst) continue;
        worst = ratio;
        (oracle ? worst_oracle_where : worst_robust_where) =
            std::string(kParameters[static_cast<std::size_t>(parameter)]) + ", " + name_of(road);
      }
      table.rows.push_back(row);
    }
  }
  const std::string how = "largest of 4 parameters × 3 road kinds; root mean square over " + std::to_string(seeds) +
                          " seeds × 4 radars of error / bound after 120 s; scans at 5 m/s or more";
  report.at_most("Cramér–Rao", "stationary detections only (" + worst_oracle_where + ")", worst_oracle, 1.2, "×", how);
  report.at_most("Cramér–Rao", "all detections, 25 % outliers (" + worst_robust_where + ")", worst_robust, 2.0, "×",
                 how);
  report.add(std::move(table));
}

}  // namespace boresight::bench
