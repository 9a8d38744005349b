// One-to-one assignment of least total cost between sets of any size, of which few pairs are possible.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "services/common/geometry/assignment.hpp"

namespace boresight::judge {

/// A possible pair.
struct PairCost {
  std::size_t row, column;
  double cost;
};

class Pairing {
 public:
  static constexpr std::size_t kNoPartner = static_cast<std::size_t>(-1);

  /// A row without a partner costs `cost_alone`; pairs that cost more are never chosen. Rows and columns that no chain
  /// of possible pairs connects are independent problems, so that the fixed capacity of the solver counts for each.
  void solve(std::size_t rows, std::size_t columns, std::span<const PairCost> pairs, double cost_alone);

  [[nodiscard]] std::size_t column_of(std::size_t row) const { return column_of_[row]; }
  [[nodiscard]] std::size_t row_of(std::size_t column) const { return row_of_[column]; }
  /// Sum of the costs of the chosen pairs.
  [[nodiscard]] double cost_of_pairs() const { return cost_of_pairs_; }
  /// Pairs that were not considered, because their problem exceeded geometry::Assignment::kCapacity.
  [[nodiscard]] std::size_t not_considered() const { return not_considered_; }

 private:
  struct Entry {
    std::size_t root;
    PairCost pair;
  };
  [[nodiscard]] std::size_t root_of(std::size_t node);
  void solve_group(std::span<const Entry> group, double cost_alone);
  void take(const PairCost& pair);

  geometry::Assignment assignment_;
  std::vector<std::size_t> column_of_, row_of_;
  std::vector<std::size_t> parent_;  // union-find over rows, then columns
  std::vector<Entry> entries_;
  std::vector<std::size_t> group_rows_, group_columns_;
  double cost_of_pairs_ = 0.0;
  std::size_t not_considered_ = 0;
};

}  // namespace boresight::judge
