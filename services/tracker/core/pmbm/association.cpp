#include "services/tracker/core/pmbm/association.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::tracking::pmbm {

namespace {

/// log(1 + e^x)
double log_one_more(double x) {
  return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x)));
}

}  // namespace

Association::Association(const Parameters& parameters, const Capacity& capacity)
    : parameters_(parameters),
      capacity_(capacity),
      max_cells_(2 * capacity.group_objects),
      log_min_share_(std::log(parameters.min_share)),
      gates_(capacity.rows, capacity.group_objects, capacity.group_measurements),
      known_(2 * capacity.known_associations),
      memory_(capacity.remembered_cells),
      soft_memory_(capacity.remembered_cells) {
  const std::size_t locals = group_pool(capacity), n = capacity.group_measurements;
  predictions_.reserve(locals);
  log_existence_.reserve(locals);
  log_missed_.reserve(locals);
  source_keys_.reserve(locals);
  for (std::size_t l = 0; l < locals; ++l) source_keys_.push_back(CellMemory::source_key(l + 1));
  existence_.reserve(locals);
  gated_.reserve(locals * n);
  log_new_.reserve(n);
  log_alone_.reserve(n);
  locals_.reserve(capacity.group_objects);
  for (State* s : {&state_, &best_, &trial_}) {
    reserve(*s);
    s->values.reserve(max_cells_);
  }
  contents_.reserve(max_cells_);
  changed_.reserve(max_cells_);
  for (auto* v : {&side_a_, &side_b_, &members_}) v->reserve(n);
  done_.reserve(n);
  is_shared_.reserve(n);
  renamed_.reserve(max_cells_);
  first_link_.reserve(n + 1);
  own_link_.reserve(n);
  for (auto* v : {&share_, &next_share_}) v->resize(n * (max_cells_ + 1));
  linked_.reserve(n * (max_cells_ + 1));
  gain_.reserve(max_cells_ + 1);
  soft_.reserve(max_cells_);
  soft_values_.reserve(max_cells_);
  candidates_.resize(2 * capacity.candidates);
  for (Candidate& c : candidates_) {
    reserve(c);
    c.shared.reserve(max_cells_);
  }
  starts_.resize(capacity.rows);
  for (Candidate& c : starts_) reserve(c);
}

void Association::reserve(Cells& cells) const {
  cells.labels.reserve(capacity_.group_measurements);
  cells.cells.reserve(max_cells_);
}

std::span<const Candidate> Association::search(Model& model, PoissonPart& poisson, const Group& group,
                                               std::span<const Measurement<double>> measurements,
                                               std::span<const std::uint64_t> keys, std::uint32_t& work) {
  model_ = &model;
  poisson_ = &poisson;
  group_ = &group;
  z_ = measurements;
  keys_ = keys;
  work_ = &work;
  const std::uint32_t left = parameters_.work_budget - std::min(parameters_.work_budget, work);
  search_limit_ = work + left / 2;
  memory_.clear();
  soft_memory_.clear();
  known_.clear();
  number_of_candidates_ = 0;
  log_top_ = -std::numeric_limits<double>::infinity();
  prepare(model, poisson, group);

  find_starts();
  for (std::size_t i = 0; i < number_of_starts_; ++i) {
    const Candidate& c = starts_[i];
    if (c.log_weight < log_top_ - parameters_.search_log) break;
    take_row(c.row);
    static_cast<Cells&>(state_) = c;
    state_.values.clear();
    rescore(state_);
    search_row();
  }

  number_of_candidates_ = prune(number_of_candidates_);
  for (std::size_t i = 0; i < number_of_candidates_ && work <= parameters_.work_budget; ++i) soften(candidates_[i]);
  number_of_candidates_ = prune(number_of_candidates_);
  return {candidates_.data(), number_of_candidates_};
}

/// The likeliest association near the prediction of each row, the likeliest row first.
void Association::find_starts() {
  number_of_starts_ = std::min(group_->rows(), starts_.size());
  gates_.clear(number_of_starts_, z_.size());
  for (std::size_t row = 0; row < number_of_starts_; ++row) {
    take_row(row);
    find_gates();
    start(state_);
    rescore(state_);
    cluster_rest(state_);
    ascend(state_);
    compact(state_);
    Candidate& c = starts_[row];
    static_cast<Cells&>(c) = state_;
    c.row = row;
    c.log_weight = log_row_ + state_.score;
  }
  std::sort(starts_.begin(), starts_.begin() + static_cast<std::ptrdiff_t>(number_of_starts_),
            [](const Candidate& a, const Candidate& b) {
              return a.log_weight != b.log_weight ? a.log_weight > b.log_weight : a.row < b.row;
            });
}

void Association::take_row(std::size_t row) {
  row_ = row;
  log_row_ = group_->log_weights[row];
  locals_.clear();
  for (std::size_t c = 0; c < group_->columns(); ++c) {
    if (group_->at(row, c) >= 0) locals_.push_back(static_cast<std::size_t>(group_->at(row, c)));
  }
}

void Association::find_gates() {
  for (std::size_t t = 0; t < locals_.size(); ++t) {
    const char* is_gated = &gated_[locals_[t] * z_.size()];
    for (std::size_t i = 0; i < z_.size(); ++i) {
      if (is_gated[i] != 0) gates_.add(row_, t, i);
    }
  }
}

void Association::prepare(Model& model, PoissonPart& poisson, const Group& group) {
  const std::size_t n = z_.size(), locals = group.pool.size();
  predictions_.clear();
  log_existence_.clear();
  log_missed_.clear();
  existence_.assign(locals, 0.0);
  gated_.assign(locals * n, 0);
  for (std::size_t l = 0; l < locals; ++l) {
    const LocalHypothesis& local = group.pool[l];
    predictions_.emplace_back(local.component, model.view(local.component));
    const Prediction<double>& p = predictions_.back();
    log_existence_.push_back(std::max(kLeastLog, std::log(local.existence)));
    log_missed_.push_back(std::log(1.0 - local.existence + local.existence * p.missed()));
    if (p.detection_probability() < parameters_.min_detection_probability || local.existence <= 0.0) continue;
    const auto is_in_gate = [&](const Measurement<double>& z) {
      return p.place_distance(z.position_m) < parameters_.cell_gate_chi2 &&
             p.range_rate_distance(z) < parameters_.cell_gate_chi2;
    };
    for (std::size_t i = 0; i < n; ++i) {
      gated_[l * n + i] = is_in_gate(z_[i]) ? 1 : 0;
    }
  }
  for (std::size_t r = 0; r < group.rows(); ++r) {
    for (std::size_t c = 0; c < group.columns(); ++c) {
      if (group.at(r, c) < 0) continue;
      const auto l = static_cast<std::size_t>(group.at(r, c));
      const LocalHypothesis& local = group.pool[l];
      existence_[l] += std::exp(group.log_weights[r]) * local.existence * local.component.source.object;
    }
  }
  model.begin_group(z_, predictions_, existence_);
  poisson.begin_group(model, z_);
  log_new_.clear();
  log_alone_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    Cell<double> cell;
    cell.add(z_[i], keys_[i]);
    ++*work_;
    log_new_.push_back(poisson.log_likelihood(model, cell));
    log_alone_.push_back(log_one_more(log_new_.back()));
  }
}

void Association::start(State& s) const {
  const std::size_t n = z_.size();
  s.objects = locals_.size();
  s.labels.assign(n, -1);
  s.cells.assign(s.objects, Cell<double>{});
  s.values.clear();
  for (std::size_t i = 0; i < n; ++i) {
    double best = log_alone_[i];
    gates_.for_objects(row_, i, [&](std::size_t t) {
      const double intensity = predictions_[locals_[t]].log_intensity(z_[i]);
      if (intensity <= best) return;
      best = intensity;
      s.labels[i] = static_cast<std::int16_t>(t);
    });
  }
}

double Association::object_value(std::size_t object, const Cell<double>& content) {
  const std::size_t l = locals_[object];
  if (content.n == 0.0) return log_missed_[l];
  return memory_.value(content.key, source_keys_[l], [&] {
    ++*work_;
    return log_existence_[l] + predictions_[l].log_likelihood(content);
  });
}

double Association::new_value(const Cell<double>& content) {
  if (content.n == 0.0) return 0.0;
  return memory_.value(content.key, CellMemory::source_key(0), [&] {
    ++*work_;
    const double log_new = poisson_->log_likelihood(*model_, content);
    // A single measurement may be clutter as well.
    return content.n == 1.0 ? log_one_more(log_new) : std::max(kLeastLog, log_new);
  });
}

double Association::cell_value(const Cells& s, std::size_t cell, const Cell<double>& content) {
  return cell < s.objects ? object_value(cell, content) : new_value(content);
}

double Association::dissolved(const State& s, std::size_t cell) const {
  double value = cell < s.objects ? log_missed_[locals_[cell]] : 0.0;
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (s.labels[i] == static_cast<std::int16_t>(cell)) value += log_alone_[i];
  }
  return value;
}

}  // namespace boresight::tracking::pmbm
