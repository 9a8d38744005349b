#include "services/tracker/core/pmbm/poisson_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking::pmbm {

PoissonPart::PoissonPart(const Parameters& parameters, const Capacity& capacity) : parameters_(parameters) {
  components_.reserve(capacity.poisson_components);
  returned_.reserve(capacity.poisson_components);
  predictions_.reserve(capacity.poisson_components);
  log_weights_.reserve(capacity.poisson_components);
  near_.reserve(capacity.poisson_components);
  detected_.reserve(capacity.poisson_components);
  log_detected_.reserve(capacity.poisson_components);
  mixture_.reserve(capacity.poisson_components);
}

void PoissonPart::predict(const Model& model, double elapsed_s) {
  for (PoissonComponent& c : components_) c.weight *= model.predict(c.component, elapsed_s);
  const auto births = model.births();
  for (const PoissonComponent& birth : births) {
    PoissonComponent sum = birth;
    for (std::size_t i = 0; i < components_.size();) {
      if (distance(sum.component, components_[i].component) > parameters_.birth_merge_distance) {
        ++i;
        continue;
      }
      const std::array<WeightedComponent<double>, 2> two{
          {{sum.weight, &sum.component}, {components_[i].weight, &components_[i].component}}};
      sum.component = merge<double>(two);
      sum.weight += components_[i].weight;
      components_[i] = components_.back();
      components_.pop_back();
    }
    if (components_.size() == components_.capacity()) components_.pop_back();
    components_.push_back(sum);
  }
}

void PoissonPart::begin_scan(const Model& model) {
  predictions_.clear();
  log_weights_.clear();
  for (const PoissonComponent& c : components_) {
    predictions_.emplace_back(c.component, model.view(c.component));
    log_weights_.push_back(std::log(c.weight));
  }
}

void PoissonPart::end_scan(const Model& model) {
  for (std::size_t i = 0; i < components_.size(); ++i) {
    components_[i].weight *= predictions_[i].missed();
    components_[i].component = predictions_[i].missed_component(components_[i].component);
  }
  static_cast<void>(model);
  for (const PoissonComponent& c : returned_) {
    if (components_.size() < components_.capacity()) components_.push_back(c);
  }
  returned_.clear();
  std::erase_if(components_, [this](const PoissonComponent& c) { return c.weight < parameters_.min_poisson_weight; });
  std::sort(components_.begin(), components_.end(),
            [](const PoissonComponent& a, const PoissonComponent& b) { return a.weight > b.weight; });
}

void PoissonPart::take_back(double weight, const Component<double>& component) {
  if (returned_.size() < returned_.capacity()) returned_.push_back({weight, component});
}

bool PoissonPart::is_near(const Measurement<double>& z) const {
  return std::any_of(predictions_.begin(), predictions_.end(), [&](const Prediction<double>& p) {
    return p.place_distance(z.position_m) <= parameters_.gate_chi2;
  });
}

void PoissonPart::begin_group(const Model& model, std::span<const Measurement<double>> group) {
  static_cast<void>(model);
  near_.clear();
  for (std::size_t i = 0; i < predictions_.size(); ++i) {
    const bool is_near = std::any_of(group.begin(), group.end(), [&](const Measurement<double>& z) {
      return predictions_[i].place_distance(z.position_m) < 2.0 * parameters_.gate_chi2;
    });
    if (is_near) near_.push_back(i);
  }
}

double PoissonPart::log_likelihood(Model& model, const Cell<double>& cell) {
  double best = -kInfinity, sum = 0.0;
  const auto add = [&best, &sum](double log_value) {
    if (log_value == -kInfinity) return;
    if (log_value > best) {
      sum = sum * std::exp(best - log_value) + 1.0;
      best = log_value;
    } else {
      sum += std::exp(log_value - best);
    }
  };
  const Vector2<double> mean = cell.mean();
  for (const std::size_t i : near_) {
    if (predictions_[i].place_distance(mean) > 2.0 * parameters_.gate_chi2) continue;
    add(log_weights_[i] + predictions_[i].log_likelihood(cell));
  }
  if (model.has_births_anywhere()) add(model.log_newborn(cell));
  return best == -kInfinity ? -kInfinity : best + std::log(sum);
}

bool PoissonPart::first_detected(Model& model, const Cell<double>& cell, Component<double>& out) {
  detected_.clear();
  log_detected_.clear();
  const Vector2<double> mean = cell.mean();
  double best = -kInfinity;
  for (const std::size_t i : near_) {
    if (predictions_[i].place_distance(mean) > 2.0 * parameters_.gate_chi2) continue;
    log_detected_.push_back(log_weights_[i] + predictions_[i].log_likelihood(cell));
    detected_.push_back(predictions_[i].updated(components_[i].component, cell));
    best = std::max(best, log_detected_.back());
  }
  if (model.has_births_anywhere() && detected_.empty()) {
    out = model.newborn(cell);
    return true;
  }
  if (model.has_births_anywhere() && detected_.size() < detected_.capacity()) {
    log_detected_.push_back(model.log_newborn(cell));
    detected_.push_back(model.newborn(cell));
    best = std::max(best, log_detected_.back());
  }
  if (detected_.empty()) return false;
  mixture_.clear();
  for (std::size_t i = 0; i < detected_.size(); ++i) {
    mixture_.push_back({std::exp(log_detected_[i] - best), &detected_[i]});
  }
  out = merge<double>(mixture_);
  return true;
}

}  // namespace boresight::tracking::pmbm
