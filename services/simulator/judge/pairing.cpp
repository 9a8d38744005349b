#include "services/simulator/judge/pairing.hpp"

#include <algorithm>
#include <numeric>

namespace boresight::judge {

namespace {

/// Place of `value` in `values`, which gets it if it is new.
std::size_t place_in(std::vector<std::size_t>& values, std::size_t value) {
  const auto found = std::find(values.begin(), values.end(), value);
  const auto place = static_cast<std::size_t>(found - values.begin());
  if (found == values.end()) values.push_back(value);
  return place;
}

}  // namespace

std::size_t Pairing::root_of(std::size_t node) {
  while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
  return node;
}

void Pairing::take(const PairCost& pair) {
  column_of_[pair.row] = pair.column;
  row_of_[pair.column] = pair.row;
  cost_of_pairs_ += pair.cost;
}

void Pairing::solve(std::size_t rows, std::size_t columns, std::span<const PairCost> pairs, double cost_alone) {
  column_of_.assign(rows, kNoPartner);
  row_of_.assign(columns, kNoPartner);
  cost_of_pairs_ = 0.0;
  parent_.resize(rows + columns);
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  entries_.clear();
  for (const PairCost& pair : pairs) {
    if (!(pair.cost < cost_alone)) continue;
    parent_[root_of(pair.row)] = root_of(rows + pair.column);
    entries_.push_back({0, pair});
  }
  for (Entry& entry : entries_) entry.root = root_of(entry.pair.row);
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.root < b.root; });
  for (std::size_t begin = 0; begin < entries_.size();) {
    std::size_t end = begin + 1;
    while (end < entries_.size() && entries_[end].root == entries_[begin].root) ++end;
    if (end - begin == 1) {
      take(entries_[begin].pair);
    } else {
      solve_group({entries_.data() + begin, end - begin}, cost_alone);
    }
    begin = end;
  }
}

void Pairing::solve_group(std::span<const Entry> group, double cost_alone) {
  group_rows_.clear();
  group_columns_.clear();
  for (const Entry& entry : group) {
    place_in(group_rows_, entry.pair.row);
    place_in(group_columns_, entry.pair.column);
  }
  constexpr std::size_t kCapacity = geometry::Assignment::kCapacity;
  assignment_.reset(group_rows_.size(), group_columns_.size(), cost_alone);
  for (const Entry& entry : group) {
    const std::size_t row = place_in(group_rows_, entry.pair.row);
    const std::size_t column = place_in(group_columns_, entry.pair.column);
    if (row >= kCapacity || column >= kCapacity) {
      ++not_considered_;
    } else {
      assignment_.set(row, column, entry.pair.cost);
    }
  }
  assignment_.solve();
  for (const Entry& entry : group) {
    const std::size_t row = place_in(group_rows_, entry.pair.row);
    const std::size_t column = place_in(group_columns_, entry.pair.column);
    if (row >= kCapacity || column >= kCapacity) continue;
    if (assignment_.column_of(row) == static_cast<std::int32_t>(column)) take(entry.pair);
  }
}

}  // namespace boresight::judge
