// The search of an association: the first cells of new objects, and ascent by single measurements.
#include <cstdint>

#include "services/tracker/core/pmbm/association.hpp"

namespace boresight::tracking::pmbm {

/// Sums the cells that are marked anew, in the order of the measurements.
void Association::sum_changed(State& s) const {
  for (std::size_t b = 0; b < s.cells.size(); ++b) {
    if (changed_[b] != 0) s.cells[b] = Cell<double>{};
  }
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (s.labels[i] < 0) continue;
    const auto b = static_cast<std::size_t>(s.labels[i]);
    if (changed_[b] != 0) s.cells[b].add(z_[i], keys_[i]);
  }
}

Cell<double> Association::sum_of(std::span<const std::size_t> measurements) const {
  Cell<double> cell;
  for (const std::size_t i : measurements) cell.add(z_[i], keys_[i]);
  return cell;
}

void Association::rescore(State& s) {
  // Cells that did not change keep their sums and their value.
  const std::size_t had = s.values.size();
  s.values.resize(s.cells.size(), 0.0);
  contents_.assign(s.cells.size(), {});
  s.score = 0.0;
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (s.labels[i] < 0) {
      s.score += log_alone_[i];
      continue;
    }
    Content& c = contents_[static_cast<std::size_t>(s.labels[i])];
    c.key ^= keys_[i];
    c.n += 1.0;
  }
  changed_.assign(s.cells.size(), 0);
  for (std::size_t b = 0; b < s.cells.size(); ++b) {
    if (s.cells[b].key != contents_[b].key || s.cells[b].n != contents_[b].n) changed_[b] = 1;
  }
  sum_changed(s);
  for (std::size_t b = 0; b < s.cells.size(); ++b) {
    if (b >= had || changed_[b] != 0 || s.cells[b].n == 0.0) s.values[b] = cell_value(s, b, s.cells[b]);
    s.score += s.values[b];
  }
}

void Association::ascend(State& s) {
  changed_.assign(s.cells.size(), 0);
  for (bool moved = true; moved && !is_spent();) {
    moved = false;
    for (std::size_t i = 0; i < z_.size(); ++i) {
      const int from = s.labels[i];
      Cell<double> left;
      double left_value = 0.0, base = log_alone_[i];
      if (from >= 0) {
        const auto f = static_cast<std::size_t>(from);
        left = s.cells[f];
        left.remove(z_[i], keys_[i]);
        if (left.n < 0.5) left = Cell<double>{};
        left_value = cell_value(s, f, left);
        base = s.values[f] - left_value;
      }
      double best = base + kRounding, to_value = 0.0;
      int to = from;
      Cell<double> to_cell;
      if (from >= 0 && log_alone_[i] > best) {
        best = log_alone_[i];
        to = -1;
      }
      for_allowed(s, i, [&](std::size_t b) {
        if (static_cast<int>(b) == from) return;
        Cell<double> with = s.cells[b];
        with.add(z_[i], keys_[i]);
        const double value = cell_value(s, b, with), gain = value - s.values[b];
        if (gain <= best) return;
        best = gain;
        to = static_cast<int>(b);
        to_value = value;
        to_cell = with;
      });
      if (to == from) continue;
      moved = true;
      s.score += best - base;
      const auto set = [&](int cell, const Cell<double>& content, double value) {
        if (cell < 0) return;
        const auto b = static_cast<std::size_t>(cell);
        s.cells[b] = content;
        s.values[b] = value;
        changed_[b] = 1;
      };
      set(from, left, left_value);
      set(to, to_cell, to_value);
      s.labels[i] = static_cast<std::int16_t>(to);
    }
  }
  sum_changed(s);  // no rounding of what came and went
}

void Association::compact(State& s) {
  // Empty cells of new objects go, and those of one measurement: that is what log_alone_ is for.
  renamed_.assign(s.cells.size(), -1);
  std::size_t kept = 0;
  for (std::size_t b = 0; b < s.cells.size(); ++b) {
    if (b >= s.objects && s.cells[b].n < 1.5) continue;
    renamed_[b] = static_cast<std::int16_t>(kept);
    if (kept != b) {
      s.cells[kept] = s.cells[b];
      s.values[kept] = s.values[b];
    }
    ++kept;
  }
  for (std::int16_t& label : s.labels) {
    if (label >= 0) label = renamed_[static_cast<std::size_t>(label)];
  }
  s.cells.resize(kept);
  s.values.resize(kept);
  rescore(s);
}

void Association::cluster_rest(State& s) {
  // Connected components of what no object has are the first new cells. What does not belong there leaves them in the
  // ascent: to judge a component before would let one false detection hide a new object.
  const double reach_m = parameters_.first_cell_links * model_->link_distance_m();
  done_.assign(z_.size(), 0);
  for (std::size_t first = 0; first < z_.size() && s.cells.size() < max_cells_; ++first) {
    if (s.labels[first] >= 0 || done_[first] != 0) continue;
    members_.assign(1, first);
    done_[first] = 1;
    for (std::size_t next = 0; next < members_.size(); ++next) {
      for (std::size_t j = 0; j < z_.size(); ++j) {
        const Measurement<double>& z = z_[members_[next]];
        if (done_[j] != 0 || s.labels[j] >= 0) continue;
        if (squared_norm(z.position_m - z_[j].position_m) > reach_m * reach_m || !model_->are_linked(z, z_[j])) {
          continue;
        }
        done_[j] = 1;
        members_.push_back(j);
      }
    }
    if (members_.size() < 2) continue;
    if (new_value(sum_of(members_)) <= kLeastLog) continue;  // nothing can be born there
    for (const std::size_t i : members_) s.labels[i] = static_cast<std::int16_t>(s.cells.size());
    s.cells.push_back({});
  }
  rescore(s);
}

}  // namespace boresight::tracking::pmbm
