#include <algorithm>

#include <fmt/format.h>

#include "interfaces/messages/names.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/drives/groups/groups.hpp"
#include "tests/benchmarks/ghosts/drives/judge/scene.hpp"

namespace boresight::bench::ghosts_drives {

namespace {

using Confusions = std::vector<judge::Confusion>;

std::string range_text(const Interval& interval) {
  return fixed(interval.low, 2) + "–" + fixed(interval.high, 2);
}

Table confusion_table(const std::string& method, const std::string& conditions, const Confusions& drives) {
  Table table{"highway_" + method,
              fmt::format("highway_multipath, {}: % of each truth by label, median over {}", method, conditions),
              {"truth (count)"},
              {}};
  constexpr std::array kLabels = {Provenance::kMoving,     Provenance::kStationary, Provenance::kGhostType1,
                                  Provenance::kGhostType2, Provenance::kClutter,    Provenance::kAmbiguity,
                                  Provenance::kUnknown};
  for (const Provenance label : kLabels) {
    table.header.emplace_back(label == Provenance::kUnknown ? "unclassified" : name_of(label));
  }
  for (const PublishedRow& row : kPublishedRows) {
    table.rows.push_back({fmt::format("{} ({:.0f})", name_of(row.truth), count_of(drives, row.truth).median)});
    for (const Provenance label : kLabels) {
      table.rows.back().push_back(fixed(percent_of_cell(drives, row.truth, label).median, 2));
    }
  }
  return table;
}

/// Each cell of the published table beside both methods, with the bar of the method `evidence`.
Table cells_table(const std::string& conditions, const Confusions& published, const Confusions& evidence,
                  Findings& findings) {
  Table table{"highway_cells",
              "highway_multipath: each cell of the published table, %, median over " + conditions,
              {"truth → label", "Le Ba Thanh 2023", "published", "evidence", "95 % interval", "bar", "result"},
              {}};
  for (const PublishedRow& row : kPublishedRows) {
    for (std::size_t k = 0; k < kPublishedLabels.size(); ++k) {
      const Provenance label = kPublishedLabels[k];
      const MedianFigure own = percent_of_cell(evidence, row.truth, label);
      const Limits limits = cell_limits(row.truth, label, row.percent[k]);
      table.rows.push_back({fmt::format("{} → {}", name_of(row.truth), name_of(label)), fixed(row.percent[k], 2),
                            fixed(percent_of_cell(published, row.truth, label).median, 2), fixed(own.median, 2),
                            range_text(own.interval), text_of(limits), findings.judge(own.interval, limits)});
    }
  }
  return table;
}

/// Whether the scene is as hard as the original: numbers of detections, and the diagonal of the published method.
Table scene_table(const std::string& conditions, const Confusions& published, Findings& findings) {
  constexpr double kCounts = 0.2, kDiagonal_percent = 5.0;
  Table table{"highway_scene",
              "highway_multipath: agreement with the original, median over " + conditions,
              {"figure", "Le Ba Thanh 2023", "measured", "95 % interval", "bar", "result"},
              {}};
  for (const PublishedRow& row : kPublishedRows) {
    const MedianFigure count = count_of(published, row.truth);
    const Limits limits{(1.0 - kCounts) * row.count, (1.0 + kCounts) * row.count};
    table.rows.push_back({fmt::format("detections: {}", name_of(row.truth)), fixed(row.count, 0),
                          fixed(count.median, 0), fixed(count.interval.low, 0) + "–" + fixed(count.interval.high, 0),
                          fixed(limits.low, 0) + "–" + fixed(limits.high, 0), findings.judge(count.interval, limits)});
  }
  for (const PublishedRow& row : kPublishedRows) {
    for (std::size_t k = 0; k < kPublishedLabels.size(); ++k) {
      if (kPublishedLabels[k] != row.truth) continue;
      const MedianFigure right = percent_of_cell(published, row.truth, row.truth);
      const Limits limits{row.percent[k] - kDiagonal_percent, std::min(100.0, row.percent[k] + kDiagonal_percent)};
      table.rows.push_back({fmt::format("published: {} classified correctly, %", name_of(row.truth)),
                            fixed(row.percent[k], 2), fixed(right.median, 2), range_text(right.interval),
                            text_of(limits), findings.judge(right.interval, limits)});
    }
  }
  return table;
}

}  // namespace

void highway(const Setup& setup, Findings& findings) {
  const ghosts::EvidenceWeights weights = start_weights(setup, "ideal");
  std::array<Confusions, kMethods.size()> by_method;
  for (Confusions& drives : by_method) drives.resize(setup.highway_seeds);
  parallel_for(kMethods.size() * setup.highway_seeds, setup.jobs, [&](std::size_t i) {
    const std::size_t method = i % kMethods.size(), drive = i / kMethods.size();
    by_method[method][drive] =
        run_scene(setup.first_seed + drive, setup.longest_s, config_of(kMethods[method], weights));
  });
  const std::string conditions =
      fmt::format("seeds {} … {}", setup.first_seed, setup.first_seed + setup.highway_seeds - 1);
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    findings.add(confusion_table(kMethods[m].name, conditions, by_method[m]));
  }
  findings.add(scene_table(conditions, by_method.front(), findings));
  findings.add(cells_table(conditions, by_method.front(), by_method.back(), findings));
}

}  // namespace boresight::bench::ghosts_drives
