// The search of an association: moves of whole cells from one local optimum to others.
#include <algorithm>
#include <cmath>

#include "services/tracker/core/pmbm/association.hpp"

namespace boresight::tracking::pmbm {

void Association::search_row() {
  do {
    keep(state_);
    best_ = state_;
    improved_ = false;
    for (std::size_t b = 0; b < state_.cells.size() && !is_spent(); ++b) {
      if (state_.cells[b].n > 0.0) move_cell(b);
    }
    if (improved_) state_ = best_;
  } while (improved_ && !is_spent());
  dissolve_unlikely(state_);
  compact(state_);
  keep(state_);
  keep_alternatives();
}

void Association::consider(State& trial) {
  ascend(trial);
  compact(trial);
  if (trial.score > best_.score + kRounding) {
    best_ = trial;
    improved_ = true;
  } else if (log_row_ + trial.score > log_top_ - parameters_.search_log) {
    keep(trial);
  }
}

void Association::relabel(std::size_t from, std::int16_t to) {
  trial_ = state_;
  for (std::int16_t& l : trial_.labels) {
    if (l == static_cast<std::int16_t>(from)) l = to;
  }
  rescore(trial_);
  consider(trial_);
}

void Association::move_cell(std::size_t cell) {
  if (dissolved(state_, cell) > state_.values[cell]) relabel(cell, -1);
  if (split(state_, cell)) split_cell(cell);
  exchange_cells(cell);
}

/// Part of the cell is of something new, or of an object that has nothing.
void Association::split_cell(std::size_t cell) {
  const bool of_object = cell < state_.objects;
  for (int side = 0; side < (of_object ? 2 : 1); ++side) {
    const std::vector<std::size_t>& part = side != 0 ? side_a_ : side_b_;
    const auto give = [&](std::size_t to) {
      for (const std::size_t i : part) trial_.labels[i] = static_cast<std::int16_t>(to);
      rescore(trial_);
      if (trial_.score > state_.score - parameters_.search_log) consider(trial_);
    };
    trial_ = state_;
    trial_.cells.push_back({});
    give(trial_.cells.size() - 1);
    const Cell<double> given = sum_of(part), rest = sum_of(side != 0 ? side_b_ : side_a_);
    for (std::size_t u = 0; u < state_.objects; ++u) {
      if (u == cell || state_.cells[u].n > 0.0) continue;
      const double gain =
          object_value(u, given) - state_.values[u] + cell_value(state_, cell, rest) - state_.values[cell];
      if (gain < -parameters_.search_log - kRounding) continue;
      trial_ = state_;
      give(u);
    }
  }
}

/// The cell goes to an object that has none, is swapped with that of another, or a new object's is of another object.
void Association::exchange_cells(std::size_t cell) {
  const State& s = state_;
  const bool of_object = cell < s.objects;
  const double left = of_object ? log_missed_[locals_[cell]] : 0.0;
  for (std::size_t u = 0; u < s.objects; ++u) {
    if (u == cell || (of_object && cell < u && s.cells[u].n > 0.0)) continue;
    const double least = s.values[u] + s.values[cell] - parameters_.candidate_log;
    if (s.cells[u].n == 0.0) {
      if (object_value(u, s.cells[cell]) + left > least) relabel(cell, static_cast<std::int16_t>(u));
      continue;
    }
    if (!of_object) {
      Cell<double> joined = s.cells[u];
      joined.join(s.cells[cell]);
      if (object_value(u, joined) > least) relabel(cell, static_cast<std::int16_t>(u));
      continue;
    }
    if (object_value(u, s.cells[cell]) + object_value(cell, s.cells[u]) <= least) continue;
    trial_ = s;
    for (std::int16_t& l : trial_.labels) {
      const auto a = static_cast<std::int16_t>(cell), b = static_cast<std::int16_t>(u);
      l = l == a ? b : l == b ? a : l;
    }
    rescore(trial_);
    consider(trial_);
  }
}

bool Association::split(const State& s, std::size_t cell) {
  // Two means, started along the long axis.
  const Cell<double>& c = s.cells[cell];
  if (c.n < 4.0 || s.cells.size() >= max_cells_) return false;  // each side has two
  const Vector2<double> mean = c.mean();
  const Symmetric2<double> covariance = (1.0 / c.n) * c.scatter();
  const double angle = 0.5 * std::atan2(2.0 * covariance.xy, covariance.xx - covariance.yy);
  const Vector2<double> axis{std::cos(angle), std::sin(angle)};
  const double half = std::sqrt(std::max(0.0, quadratic(covariance, axis)));
  Vector2<double> a = mean + half * axis, b = mean - half * axis;
  members_.clear();
  side_a_.clear();
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (s.labels[i] == static_cast<std::int16_t>(cell)) members_.push_back(i);
  }
  for (std::size_t before = members_.size(); before != side_a_.size();) {
    before = side_a_.size();
    side_a_.clear();
    side_b_.clear();
    Vector2<double> sum_a, sum_b;
    for (const std::size_t i : members_) {
      const Vector2<double>& p = z_[i].position_m;
      if (squared_norm(p - a) < squared_norm(p - b)) {
        side_a_.push_back(i);
        sum_a = sum_a + p;
      } else {
        side_b_.push_back(i);
        sum_b = sum_b + p;
      }
    }
    if (side_a_.empty() || side_b_.empty()) return false;
    a = (1.0 / static_cast<double>(side_a_.size())) * sum_a;
    b = (1.0 / static_cast<double>(side_b_.size())) * sum_b;
  }
  return true;
}

/// Cells of new objects that are likelier to be nothing but clutter become that.
void Association::dissolve_unlikely(State& s) {
  for (std::size_t b = s.objects; b < s.cells.size(); ++b) {
    if (dissolved(s, b) <= s.values[b]) continue;
    for (std::int16_t& label : s.labels) {
      if (label == static_cast<std::int16_t>(b)) label = -1;
    }
    s.cells[b] = Cell<double>{};
  }
}

void Association::keep_alternatives() {
  // Each cell may be nothing but clutter.
  for (std::size_t b = 0; b < state_.cells.size(); ++b) {
    if (state_.cells[b].n == 0.0 || dissolved(state_, b) - state_.values[b] < -parameters_.candidate_log) continue;
    trial_ = state_;
    for (std::int16_t& l : trial_.labels) {
      if (l == static_cast<std::int16_t>(b)) l = -1;
    }
    rescore(trial_);
    keep(trial_);
  }
  // Each missed object may have one of the measurements that seem to be clutter.
  for (std::size_t t = 0; t < state_.objects; ++t) {
    if (state_.cells[t].n > 0.0) continue;
    for (std::size_t i = 0; i < z_.size() && !is_spent(); ++i) {
      if (state_.labels[i] >= 0 || !gates_.has(row_, t, i)) continue;
      Cell<double> one;
      one.add(z_[i], keys_[i]);
      if (object_value(t, one) < state_.values[t] + log_alone_[i] - parameters_.candidate_log) continue;
      trial_ = state_;
      trial_.labels[i] = static_cast<std::int16_t>(t);
      rescore(trial_);
      keep(trial_);
    }
  }
}

}  // namespace boresight::tracking::pmbm
