#include "services/tracker/core/pmbm/pmbm_filter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace boresight::tracking::pmbm {

namespace {

/// Of a table with so many entries.
std::size_t table_size(std::size_t entries) {
  return std::bit_ceil(2 * entries + 2);
}

}  // namespace

PmbmFilter::PmbmFilter(const Parameters& parameters, const Capacity& capacity)
    : parameters_(parameters),
      capacity_(capacity),
      poisson_(parameters, capacity),
      current_(capacity),
      next_(capacity),
      grouping_(parameters, capacity),
      association_(parameters, capacity),
      before_(capacity),
      after_(capacity),
      updated_(table_size(group_pool(capacity))),
      new_objects_(table_size(capacity.group_objects)) {
  keys_.reserve(capacity.measurements);
  for (std::size_t i = 0; i < capacity.measurements; ++i) keys_.push_back(mixed(i + 1));
  group_z_.reserve(capacity.group_measurements);
  group_keys_.reserve(capacity.group_measurements);
  new_locals_.reserve(capacity.group_objects);
  columns_.reserve(capacity.group_objects);
  by_local_.reserve(group_pool(capacity));
  by_object_.reserve(capacity.group_objects);
  mixture_.reserve(std::max(capacity.candidates, capacity.rows));
  estimates_.reserve(capacity.objects);
  likely_.reserve(capacity.objects);
  explained_.reserve(std::max(capacity.measurements, kMaxDetections));
}

void PmbmFilter::clear() {
  poisson_.clear();
  current_.clear();
  estimates_.clear();
}

// Granström, Fatemi and Svensson 2020, §III. Equations: docs/algorithms/tracking.md.
void PmbmFilter::step(Model& model, double elapsed_s) {
  work_ = {};
  explained_.assign(model.measurements().size(), 0.0);
  predict(model, elapsed_s);  // (T2) and (T3), of the Bernoulli components and the Poisson part
  poisson_.begin_scan(model);
  next_.clear();
  // Gates of (T4), with the offsets of (T11) and (T12), connect objects and measurements to independent groups. Each
  // has its association by (T10) with the likelihoods of (T13), its update by (T5) to (T9), and its reduction.
  for (const WorkItem& item : grouping_.find(model, poisson_, current_, work_)) update(model, item);
  poisson_.end_scan(model);
  std::swap(current_, next_);
  join_parts(model);  // (T15)
  work_.budget_reached = association_.take_was_cut() || work_.likelihood_evaluations > parameters_.work_budget;
  report();
}

void PmbmFilter::predict(const Model& model, double elapsed_s) {
  for (std::size_t g = 0; g < current_.size(); ++g) {
    for (LocalHypothesis& local : current_.pool(g)) local.existence *= model.predict(local.component, elapsed_s);
  }
  poisson_.predict(model, elapsed_s);
}

void PmbmFilter::update(Model& model, const WorkItem& item) {
  before_.clear();
  before_.add_row(0.0);
  for (const std::size_t g : grouping_.groups(item)) {
    if (!current_.join_into(before_, g, capacity_.rows)) ++work_.dropped_objects;
  }
  after_.clear();
  const auto measurements = grouping_.measurements(item);
  if (measurements.empty()) {
    update_undetected(model);
  } else {
    group_z_.clear();
    group_keys_.clear();
    for (const std::size_t i : measurements) {
      group_z_.push_back(model.measurements()[i]);
      group_keys_.push_back(keys_[i]);
    }
    const auto candidates =
        association_.search(model, poisson_, before_, group_z_, group_keys_, work_.likelihood_evaluations);
    make_rows(model, candidates);
    after_.normalise();
    note_explained(candidates, measurements);
  }
  reduce(model);
  store();
}

void PmbmFilter::update_undetected(Model& model) {
  // No measurement is near: every local hypothesis is missed, and the rows change their weights.
  after_.ids.assign(before_.ids.begin(), before_.ids.end());
  by_local_.clear();
  for (const LocalHypothesis& local : before_.pool) {
    const Absence<double> absence(local.component, model.view(local.component));
    const double q = absence.probability();
    by_local_.push_back(std::log(1.0 - local.existence + local.existence * q));
    static_cast<void>(
        after_.add_local({missed_existence(local.existence, q), 0.0, {}, absence.after(local.component)}));
  }
  for (std::size_t r = 0; r < before_.rows(); ++r) {
    after_.add_row(before_.log_weights[r]);
    for (std::size_t c = 0; c < before_.columns(); ++c) {
      after_.at(r, c) = before_.at(r, c);
      if (before_.at(r, c) >= 0) after_.log_weights[r] += by_local_[static_cast<std::size_t>(before_.at(r, c))];
    }
  }
  after_.normalise();
}

void PmbmFilter::make_rows(Model& model, std::span<const Candidate> candidates) {
  after_.ids.assign(before_.ids.begin(), before_.ids.end());
  updated_.clear();
  new_objects_.clear();
  new_locals_.clear();
  for (const Candidate& candidate : candidates) {
    if (!after_.add_row(candidate.log_weight)) break;
    const std::size_t row = after_.rows() - 1;
    std::size_t object = 0;
    for (std::size_t c = 0; c < before_.columns(); ++c) {
      const std::int16_t l = before_.at(candidate.row, c);
      if (l < 0) continue;
      const std::size_t cell_index = object++;
      const Cell<double>& cell = candidate.cells[cell_index];
      // The same hypothesis with the same cell is one, in whichever row.
      const std::uint64_t soft = mixed(std::bit_cast<std::uint64_t>(cell.n + 3.7 * cell.sum.x));
      const std::uint64_t key = mixed(cell.key ^ mixed(77U + static_cast<std::uint64_t>(l)) ^ soft);
      int index = updated_.find(key);
      if (index < 0) {
        const LocalHypothesis& local = before_.pool[static_cast<std::size_t>(l)];
        Prediction<double>& p = association_.prediction(static_cast<std::size_t>(l));
        LocalHypothesis next;
        if (cell.n == 0.0) {
          next = {missed_existence(local.existence, p.missed()), 0.0, {}, p.missed_component(local.component)};
          for (std::size_t i = 0; i < group_z_.size() && next.shared == 0.0; ++i) {
            if (association_.is_taken(candidate, static_cast<std::size_t>(l), i)) next.shared = 1.0;
          }
        } else {
          next = {
              1.0, cell.n, cell.scatter(), p.updated(local.component, cell), cell.mean(), candidate.shared[cell_index]};
        }
        index = after_.add_local(next);
        if (index < 0) {
          ++work_.dropped_objects;
          continue;
        }
        static_cast<void>(updated_.insert(key, index));
      }
      after_.at(row, c) = static_cast<std::int16_t>(index);
    }
    for (std::size_t b = candidate.objects; b < candidate.cells.size(); ++b) {
      if (candidate.cells[b].n > 1.0) add_new_object(model, row, candidate.cells[b], 1.0);
    }
    for (std::size_t i = 0; i < group_z_.size(); ++i) {
      if (candidate.labels[i] >= 0) continue;
      const double existence = std::exp(association_.log_new(i) - association_.log_alone(i));
      if (existence < parameters_.min_existence) continue;
      Cell<double> cell;
      cell.add(group_z_[i], group_keys_[i]);
      add_new_object(model, row, cell, std::min(existence, 1.0));
    }
  }
}

void PmbmFilter::add_new_object(Model& model, std::size_t row, const Cell<double>& cell, double existence) {
  int column = new_objects_.find(cell.key);
  if (column < 0) {
    LocalHypothesis local{existence, cell.n, cell.scatter(), {}, cell.mean()};
    if (!poisson_.first_detected(model, cell, local.component)) return;
    local.component.label = next_id_;
    const int index = after_.columns() < after_.stride ? after_.add_local(local) : -1;
    if (index < 0) {
      ++work_.dropped_objects;
      return;
    }
    column = static_cast<int>(after_.columns());
    after_.add_column(next_id_++);
    new_locals_.push_back(index);
    static_cast<void>(new_objects_.insert(cell.key, column));
  }
  const auto c = static_cast<std::size_t>(column);
  after_.at(row, c) = static_cast<std::int16_t>(new_locals_[c - before_.columns()]);
}

void PmbmFilter::note_explained(std::span<const Candidate> candidates, std::span<const std::size_t> measurements) {
  for (std::size_t r = 0; r < after_.rows(); ++r) {
    const double weight = std::exp(after_.log_weights[r]);
    by_object_.clear();  // its existence in this row
    for (std::size_t c = 0; c < before_.columns(); ++c) {
      if (before_.at(candidates[r].row, c) < 0) continue;
      const std::int16_t l = after_.at(r, c);
      by_object_.push_back(l < 0 ? 0.0 : weight * after_.pool[static_cast<std::size_t>(l)].existence);
    }
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      const std::int16_t label = candidates[r].labels[i];
      if (label < 0 || static_cast<std::size_t>(label) >= by_object_.size()) continue;
      explained_[measurements[i]] += by_object_[static_cast<std::size_t>(label)];
    }
  }
}

void PmbmFilter::reduce(const Model& model) {
  after_.merge_similar_rows(parameters_.merge_distance);
  after_.prune_rows(parameters_.prune_weight, capacity_.rows);
  for (std::size_t c = 0; c < after_.columns(); ++c) {
    const double existence = after_.existence(c);
    if (existence >= parameters_.min_existence) continue;
    mixture_.clear();
    for (std::size_t r = 0; r < after_.rows(); ++r) {
      const std::int16_t l = after_.at(r, c);
      if (l < 0) continue;
      const LocalHypothesis& local = after_.pool[static_cast<std::size_t>(l)];
      mixture_.push_back({std::exp(after_.log_weights[r]) * local.existence, &local.component});
    }
    if (!model.has_births_anywhere() && !mixture_.empty() && existence > parameters_.min_poisson_weight) {
      poisson_.take_back(existence, merge<double>(mixture_));
    }
    for (std::size_t r = 0; r < after_.rows(); ++r) after_.at(r, c) = -1;
  }
  after_.join_equal_rows();
}

void PmbmFilter::store() {
  columns_.clear();
  for (std::size_t c = 0; c < after_.columns(); ++c) {
    bool same = true;
    for (std::size_t r = 1; r < after_.rows() && same; ++r) same = after_.at(r, c) == after_.at(0, c);
    if (!same) {
      columns_.push_back(c);
      continue;
    }
    if (after_.at(0, c) < 0) continue;
    if (!next_.store_alone(after_.ids[c], after_.pool[static_cast<std::size_t>(after_.at(0, c))])) {
      ++work_.dropped_objects;
    }
  }
  if (!columns_.empty() && !next_.store(after_, columns_)) {
    work_.dropped_objects += static_cast<std::uint32_t>(columns_.size());
  }
}

void PmbmFilter::join_parts(Model& model) {
  likely_.clear();
  for (std::size_t g = 0; g < current_.size(); ++g) {
    for (std::size_t c = 0; c < current_.ids(g).size(); ++c) {
      const ObjectEstimate e = estimate(g, c);
      if (e.existence > parameters_.join_existence) likely_.push_back({g, c, e.id, e.component});
    }
  }
  for (std::size_t a = 0; a < likely_.size(); ++a) {
    for (std::size_t b = a + 1; b < likely_.size(); ++b) {
      Likely whole = likely_[a], part = likely_[b];
      const double part_in_whole = model.log_odds_of_part(*whole.component, *part.component);
      const double whole_in_part = model.log_odds_of_part(*part.component, *whole.component);
      if (std::max(part_in_whole, whole_in_part) <= 0.0) continue;
      if (whole_in_part > part_in_whole) std::swap(whole, part);
      const std::uint32_t label = std::min(whole.label, part.label);
      model.join(*whole.component, *part.component, label);
      // Detections of both add up.
      const double rate = part.component->rate_shape / part.component->rate_inverse_scale;
      for (LocalHypothesis& local : current_.pool(whole.group)) {
        Component<double>& c = local.component;
        if (c.label != whole.label) continue;
        c.rate_inverse_scale = c.rate_shape / (c.rate_shape / c.rate_inverse_scale + rate);
        c.label = label;
      }
      current_.rename(whole.group, whole.column, label);
      current_.erase(part.group, part.column);
      whole.label = label;
      likely_[a] = whole;
      likely_.erase(likely_.begin() + static_cast<std::ptrdiff_t>(b--));
    }
  }
}

ObjectEstimate PmbmFilter::estimate(std::size_t g, std::size_t c) {
  const auto pool = current_.pool(g);
  const auto weights = current_.log_weights(g);
  by_local_.assign(pool.size(), 0.0);
  ObjectEstimate e;
  double best = 0.0;
  for (std::size_t r = 0; r < weights.size(); ++r) {
    const std::int16_t index = current_.at(g, r, c);
    if (index < 0) continue;
    const auto l = static_cast<std::size_t>(index);
    const double w = std::exp(weights[r]) * pool[l].existence;
    e.source_existence += w;
    e.existence += w * pool[l].component.source.object;
    by_local_[l] += w;
    if (by_local_[l] <= best) continue;
    best = by_local_[l];
    e.component = &pool[l].component;
    e.detections = pool[l].detections;
    e.scatter = pool[l].scatter;
    e.mean_m = pool[l].mean_m;
    e.shared = pool[l].shared;
  }
  e.id = current_.ids(g)[c];
  e.detected = e.detections > 0.0;
  return e;
}

void PmbmFilter::report() {
  estimates_.clear();
  for (std::size_t g = 0; g < current_.size(); ++g) {
    for (std::size_t c = 0; c < current_.ids(g).size(); ++c) {
      const ObjectEstimate e = estimate(g, c);
      if (e.component != nullptr && e.source_existence >= parameters_.report_existence) estimates_.push_back(e);
    }
  }
  std::sort(estimates_.begin(), estimates_.end(), [](const ObjectEstimate& a, const ObjectEstimate& b) {
    return a.existence != b.existence ? a.existence > b.existence : a.id < b.id;
  });
}

}  // namespace boresight::tracking::pmbm
