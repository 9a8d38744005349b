#include "tests/benchmarks/ghosts/common/curves.hpp"

namespace boresight::bench {

namespace {

/// Bins with fewer detections are not drawn: their share is too uncertain.
constexpr std::uint64_t kMinDetections = 50;

Reliability together(const std::vector<Outcome>& outcomes) {
  Reliability sum;
  for (const Outcome& o : outcomes) sum.add(o.reliability);
  return sum;
}

}  // namespace

void add_reliability(const std::string& name, const std::string& title, const std::string& how,
                     std::span<const NamedGhostMethod> methods, const std::vector<std::vector<Outcome>>& outcomes,
                     Report& report) {
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const Reliability reliability = together(outcomes[m]);
    Curve curve{"reliability", title, methods[m].name, {}};
    for (const Reliability::Bin& bin : reliability.bins()) {
      if (bin.count >= kMinDetections) curve.points.emplace_back(100.0 * bin.mean_probability(), 100.0 * bin.share());
    }
    report.add(std::move(curve));
    report.beside("probability", title + ", " + methods[m].name + ": expected calibration error",
                  100.0 * reliability.calibration_error(), "%",
                  how + "; " + std::to_string(reliability.count()) + " detections; Brier score " +
                      fixed(reliability.brier_score(), 4));
    if (m + 1 < methods.size()) continue;
    Table table{name,
                title + ", " + methods[m].name + ": ghost_probability and the true share of ghosts and clutter; " + how,
                {"ghost_probability", "detections", "mean probability, %", "true share, %"},
                {}};
    for (std::size_t b = 0; b < Reliability::kBins; ++b) {
      const Reliability::Bin& bin = reliability.bins()[b];
      table.rows.push_back({number(Reliability::kEdges[b]) + "–" + number(Reliability::kEdges[b + 1]),
                            std::to_string(bin.count), fixed(100.0 * bin.mean_probability(), 1),
                            fixed(100.0 * bin.share(), 1)});
    }
    report.add(std::move(table));
  }
}

void add_comparison(const std::string& panel, const std::string& what, const std::string& who, double percent,
                    Report& report) {
  report.add(Curve{"compare", panel + "|" + what, who, {{0.0, percent}}});
}

}  // namespace boresight::bench
