// Drives of three minutes with yaw-rate bias, rear-axle slip, body pitch and braking pitch, singly and all at once.
#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

using simulator::AlignmentSpec;

struct Disturbance {
  const char* name;
  void (*keep)(AlignmentSpec&);  ///< switches off the disturbances of the other cases
};

void none_but(AlignmentSpec& spec, bool bias, bool slip, bool body_pitch, bool braking) {
  if (!bias) spec.yaw_rate_bias_radps = 0.0;
  if (!slip) spec.slip_coefficient_radps2pm = 0.0;
  if (!body_pitch) spec.body_pitch_std_rad = 0.0;
  if (!braking) spec.body_pitch_per_acceleration_radps2pm = 0.0;
}

const Disturbance kDisturbances[] = {
    {"yaw-rate bias", [](AlignmentSpec& s) { none_but(s, true, false, false, false); }},
    {"slip", [](AlignmentSpec& s) { none_but(s, false, true, false, false); }},
    {"body pitch", [](AlignmentSpec& s) { none_but(s, false, false, true, false); }},
    {"braking pitch", [](AlignmentSpec& s) { none_but(s, false, false, false, true); }},
    {"all", [](AlignmentSpec&) {}},
};

}  // namespace

void disturbed(const Options& options, Report& report) {
  using simulator::RoadKind;
  Table table{"disturbed",
              "disturbed drives of 180 s: median over seeds of the worst radar (95 % quantile)",
              {"disturbance, road", "k_v", "yaw °", "pitch °", "roll °"},
              {}};
  double worst_yaw = 0.0, worst_pitch = 0.0;
  const std::size_t all_seeds = options.seeds(24), single_seeds = options.seeds(8);
  for (const Disturbance& one : kDisturbances) {
    const bool all = std::string(one.name) == "all";
    for (const RoadKind road : {RoadKind::kCity, RoadKind::kMixed}) {
      std::vector<AlignmentSpec> specs;
      for (std::size_t seed = 0; seed < (all ? all_seeds : single_seeds); ++seed) {
        specs.push_back(disturbed_drive(road, options.seconds(180.0), 300 + seed));
        one.keep(specs.back());
      }
      const auto runs = run_drives(specs, own_method(options.method).make, options);
      std::vector<std::string> row = {std::string(one.name) + ", " + name_of(road)};
      for (const int parameter : {kSpeedScale, kYaw, kPitch, kRoll}) {
        const auto errors = final_errors(runs, parameter);
        const double unit = parameter == kSpeedScale ? 1.0 : kRadiansPerDegree;
        row.push_back(number(median(errors) / unit) + " (" + number(quantile(errors, 0.95) / unit) + ")");
        if (!all) continue;
        if (parameter == kYaw) worst_yaw = std::max(worst_yaw, median(errors) / unit);
        if (parameter == kPitch) worst_pitch = std::max(worst_pitch, median(errors) / unit);
      }
      table.rows.push_back(row);
    }
  }
  const std::string how = "all disturbances at once, 180 s: median over " + std::to_string(all_seeds) +
                          " seeds of the worst radar; worst of city and mixed roads";
  report.at_most("disturbed", "yaw", worst_yaw, 0.01, "°", how);
  report.at_most("disturbed", "pitch", worst_pitch, 0.05, "°", how);
  report.add(std::move(table));
}

}  // namespace boresight::bench
