// The tables of a run: each row with its measured and simulated values and its verdict.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/realism/rows/row.hpp"

namespace boresight::bench::realism {

/// Figures of all rows, in their order.
[[nodiscard]] std::vector<double> figures_of(const Statistics& statistics);

struct Column {
  std::string profile;
  Source source = Source::kNone;
  std::vector<std::vector<double>> figures;  ///< of each seed: those of all rows
};

/// Rows of one profile that have a verdict.
struct Tally {
  std::string profile;
  std::size_t met = 0, met_by_interval = 0, missed = 0, without_data = 0;
  [[nodiscard]] std::size_t judged() const { return met + met_by_interval + missed + without_data; }
  [[nodiscard]] bool all_met() const { return met + met_by_interval == judged(); }
};

struct Tables {
  std::vector<Table> sections;
  std::vector<Tally> tallies;  ///< of the profiles with a measured column
  /// Every row with a verdict is met.
  [[nodiscard]] bool all_met() const;
};

[[nodiscard]] Tables make_tables(const std::vector<Column>& columns);

}  // namespace boresight::bench::realism
