// Consistency of the stated covariance on every kind of drive. NEES is the normalised estimation error squared of each
// parameter, 1 if the stated std is right. Coverage is the share of true values inside the 95 % intervals.
#include <array>

#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/many_runs.hpp"
#include "tests/benchmarks/alignment/common/methods.hpp"

namespace boresight::bench {

namespace {

/// Sums over the estimates of one parameter that are reported as observable.
struct Consistency {
  double squares = 0.0, covered = 0.0, count = 0.0;
  void add(double error, double std) {
    const double z = error / std;
    squares += z * z;
    covered += std::abs(z) <= 1.96 ? 1.0 : 0.0;
    count += 1.0;
  }
  void add(const Consistency& other) {
    squares += other.squares;
    covered += other.covered;
    count += other.count;
  }
  [[nodiscard]] double nees() const { return squares / count; }
  [[nodiscard]] double coverage_percent() const { return 100.0 * covered / count; }
};

using Consistencies = std::array<Consistency, 4>;

void add_run(const Run& run, double duration_s, Consistencies& to) {
  // Few instants, far apart: estimates of one drive that are close in time are correlated.
  for (const double share : {0.125, 0.25, 0.5, 1.0}) {
    const Snapshot* at = nullptr;
    for (const Snapshot& s : run.snapshots) {
      if (s.time_s <= share * duration_s) at = &s;
    }
    for (const RadarError& radar : at->radars) {
      for (int p = 0; p < 4; ++p) {
        const auto i = static_cast<std::size_t>(p);
        if ((radar.observable & kParameterBits[i]) != 0) to[i].add(radar.error(p), radar.std(p));
      }
    }
  }
}

}  // namespace

void consistency(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(40);
  const double duration_s = options.seconds(120.0);
  Table table{"consistency",
              "NEES (coverage of 95 % intervals, %) of the estimates reported as observable",
              {"drive", "k_v", "roll", "pitch", "yaw"},
              {}};
  Consistencies pooled;
  constexpr double kFewest = 40.0;  // fewer estimates give no figure
  double lowest = 1.0, highest = 1.0;
  std::string lowest_where, highest_where;
  for (const DriveKind& kind : drive_kinds()) {
    std::vector<simulator::AlignmentSpec> specs;
    const std::size_t kind_seeds = kind.name == "16 radars" ? options.seeds(16) : seeds;
    for (std::size_t seed = 0; seed < kind_seeds; ++seed) specs.push_back(kind.make(duration_s, 1000 + seed));
    const auto runs = run_drives(specs, own_method(options.method).make, options);
    Consistencies of_kind;
    for (const Run& run : runs) add_run(run, duration_s, of_kind);
    std::vector<std::string> row = {kind.name};
    for (std::size_t p = 0; p < 4; ++p) {
      const Consistency& h = of_kind[p];
      pooled[p].add(h);
      row.push_back(h.count > 0.0 ? fixed(h.nees(), 2) + " (" + fixed(h.coverage_percent(), 1) + ")" : "—");
      if (h.count < kFewest) continue;
      report.add(Curve{"consistency", kParameters[p], kind.name, {{h.nees(), h.coverage_percent()}}});
      const std::string where = std::string(kParameters[p]) + ", " + kind.name;
      if (lowest_where.empty() || h.nees() < lowest) lowest = h.nees(), lowest_where = where;
      if (highest_where.empty() || h.nees() > highest) highest = h.nees(), highest_where = where;
    }
    table.rows.push_back(row);
  }
  const std::string how = std::to_string(drive_kinds().size()) + " kinds of drive × " + std::to_string(seeds) +
                          " seeds (16 radars: 16), after 15, 30, 60, 120 s";
  std::vector<std::string> row = {"**all**"};
  for (std::size_t p = 0; p < 4; ++p) {
    row.push_back(fixed(pooled[p].nees(), 2) + " (" + fixed(pooled[p].coverage_percent(), 1) + ")");
    report.within("consistency", std::string("NEES ") + kParameters[p] + ", all drives", pooled[p].nees(), 0.5, 1.5, "",
                  how);
    report.within("consistency", std::string("coverage ") + kParameters[p] + ", all drives",
                  pooled[p].coverage_percent(), 90.0, 99.0, "%", how);
  }
  report.within("consistency", "lowest NEES of a kind (" + lowest_where + ")", lowest, 0.5, 1.5, "", how);
  report.within("consistency", "highest NEES of a kind (" + highest_where + ")", highest, 0.5, 1.5, "", how);
  table.rows.push_back(row);
  report.add(std::move(table));
}

}  // namespace boresight::bench
