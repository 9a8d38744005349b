#include "services/tracker/core/pmbm/association.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::tracking::pmbm {

namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();
/// Logs below it count as it: a difference of two of them is then a number.
constexpr double kLeastLog = -1e4;
constexpr std::size_t kNew = std::numeric_limits<std::size_t>::max();  // source of a new object's cells
constexpr std::size_t kMemorySize = 8192;
constexpr std::size_t kKnownSize = 2048;
/// Rounds of moves of whole cells, sweeps of single measurements: both end earlier at a local optimum.
constexpr int kRounds = 12, kSweeps = 6;
/// Rows this much less likely than the best, and moves that lose this much before the ascent, are not searched.
constexpr double kNotSearchedLog = 12.0;
/// A singleton beyond e^30 times as likely as clutter is no clutter.
constexpr double kCertainLog = 30.0;
/// First cells of new objects: connected by this share of the link distance.
constexpr double kFirstCells = 0.7;
/// Candidates that are collected before the likeliest are taken.
constexpr std::size_t kCollected = 2;

}  // namespace

Association::Association(const Parameters& parameters, const Capacity& capacity)
    : parameters_(parameters),
      capacity_(capacity),
      max_cells_(2 * capacity.group_objects),
      known_(kKnownSize),
      memory_(kMemorySize) {
  const std::size_t locals = group_pool(capacity), n = capacity.group_measurements;
  predictions_.reserve(locals);
  log_existence_.reserve(locals);
  log_missed_.reserve(locals);
  existence_.reserve(locals);
  gated_.reserve(locals * n);
  log_new_.reserve(n);
  log_alone_.reserve(n);
  locals_.reserve(capacity.group_objects);
  for (State* s : {&state_, &best_, &trial_, &second_}) reserve(*s, capacity);
  old_cells_.reserve(max_cells_);
  for (auto* v : {&side_a_, &side_b_, &members_}) v->reserve(n);
  done_.reserve(n);
  is_shared_.reserve(n);
  renamed_.reserve(max_cells_);
  share_.reserve(n * (max_cells_ + 1));
  next_share_.reserve(n * (max_cells_ + 1));
  gain_.reserve(max_cells_ + 1);
  soft_.reserve(max_cells_);
  candidates_.resize(kCollected * capacity.candidates);
  for (Candidate& c : candidates_) {
    c.labels.reserve(n);
    c.cells.reserve(max_cells_);
  }
}

void Association::reserve(State& state, const Capacity& capacity) const {
  state.labels.reserve(capacity.group_measurements);
  state.cells.reserve(max_cells_);
  state.values.reserve(max_cells_);
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
  salt_ = mixed(salt_);
  known_.clear();
  number_of_candidates_ = 0;
  prepare(model, poisson, group);

  double top = kNothing;
  for (const double w : group.log_weights) top = std::max(top, w);
  for (std::size_t row = 0; row < group.rows(); ++row) {
    if (group.log_weights[row] < top - kNotSearchedLog) continue;
    locals_.clear();
    for (std::size_t c = 0; c < group.columns(); ++c) {
      if (group.at(row, c) >= 0) locals_.push_back(static_cast<std::size_t>(group.at(row, c)));
    }
    start(state_);
    rescore(state_);
    cluster_rest(state_);
    search_row(row, group.log_weights[row]);
  }

  const auto begin = candidates_.begin(), end = begin + static_cast<std::ptrdiff_t>(number_of_candidates_);
  std::sort(begin, end, [](const Candidate& a, const Candidate& b) { return a.log_weight > b.log_weight; });
  std::size_t kept = std::min(number_of_candidates_, capacity_.candidates);
  while (kept > 1 &&
         candidates_[kept - 1].log_weight < candidates_[0].log_weight + std::log(parameters_.prune_weight)) {
    --kept;
  }
  return {candidates_.data(), kept};
}

void Association::prepare(Model& model, PoissonPart& poisson, const Group& group) {
  const std::size_t n = z_.size(), locals = group.pool.size();
  predictions_.clear();
  log_existence_.clear();
  log_missed_.clear();
  existence_.assign(locals, 0.0);
  gated_.assign(locals * n, 0);
  // Single measurements were gated at the limit; a cell may hold some a little beyond it.
  constexpr double kWider = 1.5;
  const double gate = kWider * parameters_.gate_chi2;
  for (std::size_t l = 0; l < locals; ++l) {
    const LocalHypothesis& local = group.pool[l];
    predictions_.emplace_back(local.component, model.view(local.component));
    const Prediction<double>& p = predictions_.back();
    log_existence_.push_back(std::max(kLeastLog, std::log(local.existence)));
    log_missed_.push_back(std::log(1.0 - local.existence + local.existence * p.missed()));
    constexpr double kUnseen = 1e-3, kGone = 1e-9;
    if (p.detection_probability() < kUnseen || local.existence < kGone) continue;
    for (std::size_t i = 0; i < n; ++i) {
      gated_[l * n + i] = p.place_distance(z_[i].position_m) < gate && p.range_rate_distance(z_[i]) < gate ? 1 : 0;
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
    log_alone_.push_back(std::log1p(std::exp(std::min(kCertainLog, log_new_.back()))));
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
    for (std::size_t t = 0; t < s.objects; ++t) {
      if (gated_[locals_[t] * n + i] == 0) continue;
      const double intensity = predictions_[locals_[t]].log_intensity(z_[i]);
      if (intensity <= best) continue;
      best = intensity;
      s.labels[i] = static_cast<std::int16_t>(t);
    }
  }
}

template <typename Compute>
double Association::remembered(const Cell<double>& content, std::size_t source, const Compute& compute) {
  if (content.n != std::floor(content.n)) return compute();  // shared softly: not asked for again
  const std::uint64_t key = mixed(content.key ^ ((source + 2) * 0x9e3779b97f4a7c15U)) ^ salt_;
  Remembered& slot = memory_[static_cast<std::size_t>(key >> 40U) & (kMemorySize - 1)];
  if (slot.key != key) slot = {key, compute()};
  return slot.value;
}

double Association::object_value(std::size_t object, const Cell<double>& content) {
  const std::size_t l = locals_[object];
  if (content.n == 0.0) return log_missed_[l];
  return remembered(content, l, [&] {
    ++*work_;
    return log_existence_[l] + predictions_[l].log_likelihood(content);
  });
}

double Association::new_value(const Cell<double>& content) {
  if (content.n == 0.0) return 0.0;
  return remembered(content, kNew, [&] {
    ++*work_;
    const double log_new = poisson_->log_likelihood(*model_, content);
    // A single measurement may be clutter as well.
    return content.n == 1.0 && log_new < kCertainLog ? std::log1p(std::exp(log_new)) : std::max(kLeastLog, log_new);
  });
}

double Association::cell_value(const State& s, std::size_t cell, const Cell<double>& content) {
  return cell < s.objects ? object_value(cell, content) : new_value(content);
}

double Association::dissolved(const State& s, std::size_t cell) const {
  double value = cell < s.objects ? log_missed_[locals_[cell]] : 0.0;
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (s.labels[i] == static_cast<std::int16_t>(cell)) value += log_alone_[i];
  }
  return value;
}

void Association::rescore(State& s) {
  // Cells that did not change keep their value.
  const std::size_t had = s.values.size();
  s.values.resize(s.cells.size(), 0.0);
  old_cells_.assign(s.cells.begin(), s.cells.end());
  for (Cell<double>& c : s.cells) c = Cell<double>{};
  s.score = 0.0;
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (s.labels[i] >= 0) {
      s.cells[static_cast<std::size_t>(s.labels[i])].add(z_[i], keys_[i]);
    } else {
      s.score += log_alone_[i];
    }
  }
  for (std::size_t b = 0; b < s.cells.size(); ++b) {
    const bool changed = b >= had || s.cells[b].key != old_cells_[b].key || s.cells[b].n != old_cells_[b].n;
    if (changed || s.cells[b].n == 0.0) s.values[b] = cell_value(s, b, s.cells[b]);
    s.score += s.values[b];
  }
}

bool Association::is_allowed(const State& s, std::size_t z, std::size_t cell) const {
  if (cell < s.objects) return gated_[locals_[cell] * z_.size() + z] != 0;
  const Cell<double>& c = s.cells[cell];
  if (c.n == 0.0) return false;
  const double reach_m = 2.0 * model_->link_distance_m();
  return squared_norm(c.mean() - z_[z].position_m) < reach_m * reach_m;
}

void Association::ascend(State& s) {
  for (int sweep = 0; sweep < kSweeps && !is_spent(); ++sweep) {
    bool moved = false;
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
      constexpr double kGain = 1e-9;  // against endless exchange of equals
      double best = base + kGain, to_value = 0.0;
      int to = from;
      Cell<double> to_cell;
      if (from >= 0 && log_alone_[i] > best) {
        best = log_alone_[i];
        to = -1;
      }
      for (std::size_t b = 0; b < s.cells.size(); ++b) {
        if (static_cast<int>(b) == from || !is_allowed(s, i, b)) continue;
        Cell<double> with = s.cells[b];
        with.add(z_[i], keys_[i]);
        const double value = cell_value(s, b, with), gain = value - s.values[b];
        if (gain <= best) continue;
        best = gain;
        to = static_cast<int>(b);
        to_value = value;
        to_cell = with;
      }
      if (to == from) continue;
      moved = true;
      s.score += best - base;
      if (from >= 0) {
        s.cells[static_cast<std::size_t>(from)] = left;
        s.values[static_cast<std::size_t>(from)] = left_value;
      }
      if (to >= 0) {
        s.cells[static_cast<std::size_t>(to)] = to_cell;
        s.values[static_cast<std::size_t>(to)] = to_value;
      }
      s.labels[i] = static_cast<std::int16_t>(to);
    }
    if (!moved) break;
  }
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
  const double reach_m = kFirstCells * model_->link_distance_m();
  done_.assign(z_.size(), 0);
  for (std::size_t first = 0; first < z_.size() && s.cells.size() < max_cells_; ++first) {
    if (s.labels[first] >= 0 || done_[first] != 0) continue;
    members_.assign(1, first);
    done_[first] = 1;
    for (std::size_t next = 0; next < members_.size(); ++next) {
      for (std::size_t j = 0; j < z_.size(); ++j) {
        const Measurement<double>& z = z_[members_[next]];
        if (done_[j] != 0 || s.labels[j] >= 0) continue;
        if (squared_norm(z.position_m - z_[j].position_m) > reach_m * reach_m || !model_->are_linked(z, z_[j]))
          continue;
        done_[j] = 1;
        members_.push_back(j);
      }
    }
    if (members_.size() < 2) continue;
    Cell<double> cell;
    for (const std::size_t i : members_) cell.add(z_[i], keys_[i]);
    if (new_value(cell) <= kLeastLog) continue;  // nothing can be born there
    for (const std::size_t i : members_) s.labels[i] = static_cast<std::int16_t>(s.cells.size());
    s.cells.push_back({});
  }
  rescore(s);
}

bool Association::split(const State& s, std::size_t cell) {
  // Two means, started along the long axis.
  const Cell<double>& c = s.cells[cell];
  constexpr double kLeast = 4.0;
  if (c.n < kLeast || s.cells.size() >= max_cells_) return false;
  const Vector2<double> mean = c.mean();
  const Symmetric2<double> covariance = (1.0 / c.n) * c.scatter();
  const double angle = 0.5 * std::atan2(2.0 * covariance.xy, covariance.xx - covariance.yy);
  const Vector2<double> axis{std::cos(angle), std::sin(angle)};
  const double half = std::sqrt(std::max(0.0, quadratic(covariance, axis)));
  Vector2<double> a = mean + half * axis, b = mean - half * axis;
  members_.clear();
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (s.labels[i] == static_cast<std::int16_t>(cell)) members_.push_back(i);
  }
  constexpr int kIterations = 4;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
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

void Association::consider(State& trial, std::size_t row, double log_weight) {
  ascend(trial);
  compact(trial);
  constexpr double kBetter = 1e-6;
  if (trial.score > best_.score + kBetter) {
    best_ = trial;
    improved_ = true;
  } else if (trial.score > best_.score - parameters_.candidate_log) {
    keep(trial, row, log_weight);
  }
}

void Association::move_cells(std::size_t cell, std::size_t row, double log_weight) {
  const State& s = state_;
  const auto label = static_cast<std::int16_t>(cell);
  const auto relabel = [&](State& t, std::int16_t to) {
    t = s;
    for (std::int16_t& l : t.labels) {
      if (l == label) l = to;
    }
    rescore(t);
    consider(t, row, log_weight);
  };
  if (dissolved(s, cell) > s.values[cell]) relabel(trial_, -1);

  if (split(s, cell)) {
    const bool of_object = cell < s.objects;
    for (int side = 0; side < (of_object ? 2 : 1); ++side) {
      const std::vector<std::size_t>& part = side != 0 ? side_a_ : side_b_;
      // Part of it is of something new, or of an object that has nothing.
      trial_ = s;
      trial_.cells.push_back({});
      for (const std::size_t i : part) trial_.labels[i] = static_cast<std::int16_t>(trial_.cells.size() - 1);
      rescore(trial_);
      if (trial_.score > s.score - kNotSearchedLog) consider(trial_, row, log_weight);
      for (std::size_t u = 0; u < s.objects; ++u) {
        if (u == cell || s.cells[u].n > 0.0) continue;
        second_ = s;
        for (const std::size_t i : part) second_.labels[i] = static_cast<std::int16_t>(u);
        rescore(second_);
        if (second_.score > s.score - kNotSearchedLog) consider(second_, row, log_weight);
      }
    }
  }

  for (std::size_t u = 0; u < s.objects; ++u) {  // to another object as a whole, or swapped with it, or swallowed
    if (u == cell || (cell < s.objects && cell < u && s.cells[u].n > 0.0)) continue;
    const double before = s.values[u] + s.values[cell];
    const double least = before - parameters_.candidate_log;
    if (s.cells[u].n == 0.0) {
      const double left = cell < s.objects ? log_missed_[locals_[cell]] : 0.0;
      if (object_value(u, s.cells[cell]) + left > least) relabel(trial_, static_cast<std::int16_t>(u));
    } else if (cell < s.objects) {
      if (object_value(u, s.cells[cell]) + object_value(cell, s.cells[u]) > least) {
        trial_ = s;
        for (std::int16_t& l : trial_.labels) {
          l = l == label ? static_cast<std::int16_t>(u) : l == static_cast<std::int16_t>(u) ? label : l;
        }
        rescore(trial_);
        consider(trial_, row, log_weight);
      }
    } else {
      Cell<double> joined = s.cells[u];
      joined.join(s.cells[cell]);
      if (object_value(u, joined) > least) relabel(trial_, static_cast<std::int16_t>(u));
    }
  }
}

void Association::dissolve_unlikely(State& s) {
  for (std::size_t b = s.objects; b < s.cells.size(); ++b) {
    if (dissolved(s, b) <= s.values[b]) continue;
    for (std::int16_t& label : s.labels) {
      if (label == static_cast<std::int16_t>(b)) label = -1;
    }
    s.cells[b] = Cell<double>{};
  }
}

void Association::search_row(std::size_t row, double log_weight) {
  ascend(state_);
  compact(state_);
  for (int round = 0; round < kRounds && !is_spent(); ++round) {
    keep(state_, row, log_weight);
    best_ = state_;
    improved_ = false;
    for (std::size_t b = 0; b < state_.cells.size() && !is_spent(); ++b) {
      if (state_.cells[b].n > 0.0) move_cells(b, row, log_weight);
    }
    if (!improved_) break;
    state_ = best_;
  }
  dissolve_unlikely(state_);
  compact(state_);
  keep(state_, row, log_weight);
  // Each cell may be nothing but clutter.
  for (std::size_t b = 0; b < state_.cells.size(); ++b) {
    if (state_.cells[b].n == 0.0 || dissolved(state_, b) - state_.values[b] < -parameters_.candidate_log) continue;
    trial_ = state_;
    for (std::int16_t& l : trial_.labels) {
      if (l == static_cast<std::int16_t>(b)) l = -1;
    }
    rescore(trial_);
    keep(trial_, row, log_weight);
  }
  // Each missed object may have one of the measurements that seem to be clutter.
  for (std::size_t t = 0; t < state_.objects; ++t) {
    if (state_.cells[t].n > 0.0) continue;
    for (std::size_t i = 0; i < z_.size() && !is_spent(); ++i) {
      if (state_.labels[i] >= 0 || !is_allowed(state_, i, t)) continue;
      Cell<double> one;
      one.add(z_[i], keys_[i]);
      if (object_value(t, one) < state_.values[t] + log_alone_[i] - parameters_.candidate_log) continue;
      trial_ = state_;
      trial_.labels[i] = static_cast<std::int16_t>(t);
      rescore(trial_);
      keep(trial_, row, log_weight);
    }
  }
}

}  // namespace boresight::tracking::pmbm
