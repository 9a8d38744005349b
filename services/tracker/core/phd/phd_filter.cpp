#include "services/tracker/core/phd/phd_filter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking::phd {

namespace {

/// Settings of the parts shared with the PMBM filter. A stored group is one component.
pmbm::Parameters shared(const Parameters& p) {
  pmbm::Parameters out;
  out.gate_chi2 = p.gate_chi2;
  out.birth_merge_distance = 2.0 * p.merge_distance;
  out.min_poisson_weight = p.min_poisson_weight;
  out.min_detection_probability = p.min_detection_probability;
  return out;
}

pmbm::Capacity shared(const Capacity& c) {
  pmbm::Capacity out;
  out.measurements = c.measurements;
  out.objects = out.local_hypotheses = out.groups = c.components;
  out.group_objects = 2 * c.group_components;  // Grouping leaves half of it to new objects
  out.group_measurements = c.group_measurements;
  out.rows = out.candidates = 1;
  out.poisson_components = c.poisson_components;
  return out;
}

}  // namespace

PhdFilter::PhdFilter(const Parameters& parameters, const Capacity& c)
    : parameters_(parameters),
      capacity_(c),
      poisson_(shared(parameters), shared(c)),
      store_(shared(c)),
      grouping_(shared(parameters), shared(c)),
      assignment_(parameters, c),
      partitions_(parameters, c),
      identity_index_(std::bit_ceil(2 * c.components + 2)),
      next_index_(std::bit_ceil(2 * c.components + 2)) {
  keys_.reserve(c.measurements);
  for (std::size_t i = 0; i < c.measurements; ++i) keys_.push_back(mixed(i + 1));
  identities_.reserve(c.components);
  next_identities_.reserve(c.components);
  heaviest_.reserve(c.components);
  corrected_.reserve(2 * c.components);  // before the lightest are dropped
  components_.reserve(c.group_components);
  predicted_.reserve(c.group_components);
  predictions_.reserve(c.group_components);
  existence_.reserve(c.group_components);
  z_.reserve(c.group_measurements);
  scan_index_.reserve(c.group_measurements);
  children_.reserve(c.group_children);
  block_z_.reserve(c.group_measurements);
  block_keys_.reserve(c.group_measurements);
  log_terms_.reserve(c.cells * (c.group_components + 1));
  log_d_.reserve(c.cells);
  omega_.reserve(c.partitions);
  cell_probability_.reserve(c.cells);
  cell_explained_.reserve(c.cells);
  by_weight_.reserve(std::max(2 * c.components, c.group_children));
  is_merged_.reserve(c.group_children);
  mixture_.reserve(c.group_children);
  estimates_.reserve(c.components);
  explained_.reserve(c.measurements);
}

void PhdFilter::clear() {
  poisson_.clear();
  store_.clear();
  identities_.clear();
  estimates_.clear();
}

double PhdFilter::cardinality() const {
  double sum = 0.0;
  for (std::size_t g = 0; g < store_.size(); ++g) sum += store_.pool(g).front().existence;
  return sum;
}

void PhdFilter::step(Model& model, double elapsed_s) {
  work_ = {};
  explained_.assign(model.measurements().size(), 0.0);
  corrected_.clear();

  predict(model, elapsed_s);  // (1)
  poisson_.begin_scan(model);
  for (const pmbm::WorkItem& item : grouping_.find(model, poisson_, store_, work_)) {
    begin_group(model, item);
    for (std::size_t block = 0; block < assignment_.blocks(); ++block) {  // (5)
      partition(model, block);
      weigh_partitions(model);         // (3) and (4)
      correct_detected(model, block);  // (2), second sum
    }
    correct_missed();  // (7)
    reduce();
  }
  poisson_.end_scan(model);
  identify();  // (6)
  report();

  work_.budget_reached = work_.likelihood_evaluations > parameters_.work_budget;
}

void PhdFilter::predict(const Model& model, double elapsed_s) {
  identity_index_.clear();
  for (std::size_t i = 0; i < identities_.size(); ++i) {
    static_cast<void>(identity_index_.insert(identities_[i].id, static_cast<int>(i)));
    identities_[i].missed = identities_[i].detected = 0.0;
  }
  // An identity survives as its components do; `missed` holds the sum of their weights for a while.
  for (std::size_t g = 0; g < store_.size(); ++g) {
    pmbm::LocalHypothesis& local = store_.pool(g).front();
    local.existence *= model.predict(local.component, elapsed_s);
    identities_[static_cast<std::size_t>(identity_index_.find(store_.ids(g).front()))].missed += local.existence;
  }
  for (Identity& identity : identities_) {
    identity.existence *= identity.missed / identity.weight;
    identity.weight = identity.missed;
    identity.missed = 0.0;
  }
  poisson_.predict(model, elapsed_s);
}

void PhdFilter::begin_group(Model& model, const pmbm::WorkItem& item) {
  components_.clear();
  predicted_.clear();
  predictions_.clear();
  existence_.clear();
  children_.clear();
  for (const std::size_t g : grouping_.groups(item)) {
    const pmbm::LocalHypothesis& local = store_.pool(g).front();
    const Component<double>& c = local.component;
    const View<double> view = model.view(c);
    const auto index = static_cast<std::size_t>(identity_index_.find(store_.ids(g).front()));
    const Identity& identity = identities_[index];
    components_.push_back(c);
    predicted_.push_back({index, local.existence, std::log(local.existence), local.existence / identity.weight,
                          view.exposure * c.rate_shape / c.rate_inverse_scale,
                          identity.existence >= parameters_.object_probability});
    predictions_.emplace_back(c, view);
    existence_.push_back(identity.existence * c.source.object);
  }
  z_.clear();
  scan_index_.clear();
  for (const std::size_t i : grouping_.measurements(item)) {
    z_.push_back(model.measurements()[i]);
    scan_index_.push_back(i);
  }
  if (!z_.empty()) {
    model.begin_group(z_, predictions_, existence_);
    poisson_.begin_group(model, z_);
  }
  assignment_.find(model, z_, predicted_, predictions_);
}

void PhdFilter::add_child(const Hypothesis& child) {
  if (children_.size() == children_.capacity()) {
    ++work_.dropped_objects;
    return;
  }
  children_.push_back(child);
}

void PhdFilter::correct_missed() {
  for (std::size_t j = 0; j < components_.size(); ++j) {
    Identity& identity = identity_of(j);
    const double q = predictions_[j].missed();
    identity.missed += q * predicted_[j].weight;
    const double not_detected = 1.0 - std::min(1.0, identity.detected);
    const double weight = parameters_.as_published
                              ? q * predicted_[j].weight
                              : not_detected * missed_existence(identity.existence, q) * predicted_[j].share;
    if (weight < parameters_.prune_weight) continue;
    add_child({identity.id, {weight, 0.0, {}, predictions_[j].missed_component(components_[j])}});
  }
}

void PhdFilter::partition(const Model& model, std::size_t block) {
  block_z_.clear();
  block_keys_.clear();
  for (const std::size_t i : assignment_.block(block)) {
    block_z_.push_back(z_[i]);
    block_keys_.push_back(keys_[scan_index_[i]]);
  }
  partitions_.begin(block_z_, block_keys_);
  assignment_.add_partitions(model, block, partitions_);
  partitions_.add_by_distance(model);
  partitions_.add_split([this](const Cell<double>& cell) {
    double nearest = parameters_.gate_chi2, expected = kInfinity;
    for (std::size_t j = 0; j < components_.size(); ++j) {
      const double d2 = predictions_[j].place_distance(cell.mean());
      if (d2 >= nearest) continue;
      nearest = d2;
      expected = predicted_[j].expected_detections;
    }
    return expected;
  });
}

void PhdFilter::weigh_cell(Model& model, std::size_t index) {
  const Cell<double>& cell = partitions_.cells()[index];
  const std::size_t births = components_.size();
  double* terms = log_terms_.data() + index * (births + 1);
  const double of_clutter = cell.n == 1.0 ? 0.0 : -kInfinity;
  double best = of_clutter;
  for (std::size_t j = 0; j < births; ++j) {
    Prediction<double>& p = predictions_[j];
    terms[j] = -kInfinity;
    if (p.detection_probability() < parameters_.min_detection_probability ||
        p.place_distance(cell.mean()) > parameters_.gate_chi2)
      continue;
    terms[j] = predicted_[j].log_weight + p.log_likelihood(cell);
    ++work_.likelihood_evaluations;
    best = std::max(best, terms[j]);
  }
  terms[births] = poisson_.log_likelihood(model, cell);
  ++work_.likelihood_evaluations;
  best = std::max(best, terms[births]);
  log_d_[index] = -kInfinity;
  if (best == -kInfinity) return;
  double sum = std::exp(of_clutter - best);
  for (std::size_t j = 0; j <= births; ++j) sum += std::exp(terms[j] - best);
  log_d_[index] = best + std::log(sum);
}

void PhdFilter::weigh_partitions(Model& model) {
  const std::size_t cells = partitions_.cells().size();
  log_terms_.resize(cells * (components_.size() + 1));
  log_d_.assign(cells, kInfinity);  // not known yet
  cell_probability_.assign(cells, 0.0);
  omega_.clear();
  double best = -kInfinity, sum = 0.0;
  for (std::size_t p = 0; p < partitions_.size(); ++p) {
    if (p > 0 && work_.likelihood_evaluations > parameters_.work_budget) break;
    double log_product = partitions_.log_count(p);
    for (const std::int16_t c : partitions_.cells_of(p)) {
      const auto cell = static_cast<std::size_t>(c);
      if (log_d_[cell] == kInfinity) weigh_cell(model, cell);
      log_product += log_d_[cell];
    }
    omega_.push_back(log_product);
    best = std::max(best, log_product);
  }
  if (best == -kInfinity) {  // nothing explains these measurements
    omega_.clear();
    return;
  }
  for (double& omega : omega_) sum += omega = std::exp(omega - best);
  for (std::size_t p = 0; p < omega_.size(); ++p) {
    omega_[p] /= sum;
    for (const std::int16_t c : partitions_.cells_of(p)) cell_probability_[static_cast<std::size_t>(c)] += omega_[p];
  }
}

void PhdFilter::correct_detected(Model& model, std::size_t block) {
  const std::size_t births = components_.size();
  cell_explained_.assign(partitions_.cells().size(), 0.0);
  for (std::size_t c = 0; c < partitions_.cells().size(); ++c) {
    if (cell_probability_[c] < parameters_.prune_weight) continue;
    const Cell<double>& cell = partitions_.cells()[c];
    const double* terms = log_terms_.data() + c * (births + 1);
    for (std::size_t j = 0; j < births; ++j) {
      const double share = std::exp(terms[j] - log_d_[c]), weight = cell_probability_[c] * share;
      identity_of(j).detected += weight;
      if (weight < parameters_.prune_weight) continue;
      const Component<double> updated = predictions_[j].updated(components_[j], cell);
      cell_explained_[c] += share * updated.source.object;
      add_child({identity_of(j).id, {weight, cell.n, cell.scatter(), updated, cell.mean()}});
    }
    const double weight = cell_probability_[c] * std::exp(terms[births] - log_d_[c]);
    Component<double> newborn;
    if (weight < parameters_.prune_weight || !poisson_.first_detected(model, cell, newborn)) continue;
    add_child({kNew, {weight, cell.n, cell.scatter(), newborn, cell.mean()}});
  }
  const auto members = assignment_.block(block);
  for (std::size_t p = 0; p < omega_.size(); ++p) {
    const auto labels = partitions_.labels(p);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == Partitions::kNone) continue;
      const std::size_t in_scan = scan_index_[members[i]];
      explained_[in_scan] += omega_[p] * cell_explained_[static_cast<std::size_t>(labels[i])];
    }
  }
}

}  // namespace boresight::tracking::phd
