// The scene of Le Ba Thanh 2023: its published figures, and confusions of simulated drives.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/ghost_filter/core/method.hpp"
#include "services/simulator/judge/confusion.hpp"
#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/ghosts/common/findings.hpp"

namespace boresight::bench::ghosts_drives {

/// Labels of the published table, in its order.
inline constexpr std::array kPublishedLabels = {Provenance::kMoving, Provenance::kStationary, Provenance::kGhostType1,
                                                Provenance::kGhostType2};

/// A row of the published table (GGIW-PMBM): number of detections, % of them by label.
struct PublishedRow {
  Provenance truth;
  double count;
  std::array<double, kPublishedLabels.size()> percent;
};
inline constexpr std::array<PublishedRow, 5> kPublishedRows = {
    {{Provenance::kMoving, 1968.0, {97.71, 0.51, 1.17, 0.61}},
     {Provenance::kStationary, 27064.0, {1.32, 92.16, 3.20, 3.33}},
     {Provenance::kGhostType1, 833.0, {23.73, 0.0, 74.35, 1.92}},
     {Provenance::kGhostType2, 3153.0, {4.44, 0.25, 1.49, 93.82}},
     {Provenance::kClutter, 130.0, {24.62, 0.0, 9.23, 66.15}}}};

/// Of the method `evidence` in one cell of the table: at least the published percentage if the label is right, at most
/// if it is wrong. No bar where the published value is 0.
[[nodiscard]] Limits cell_limits(Provenance truth, Provenance label, double published_percent);

/// One drive of the scene through the chain.
[[nodiscard]] judge::Confusion run_scene(std::uint64_t seed, double longest_s, const ghosts::Config& config);

/// Median over the drives with 95 % interval; drives without such detections do not count.
struct MedianFigure {
  double median = 0.0;
  Interval interval;
};
[[nodiscard]] MedianFigure percent_of_cell(const std::vector<judge::Confusion>& drives, Provenance truth,
                                           Provenance label);
/// Number of detections, with those that the corrector rejects.
[[nodiscard]] MedianFigure count_of(const std::vector<judge::Confusion>& drives, Provenance truth);

}  // namespace boresight::bench::ghosts_drives
