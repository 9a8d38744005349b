#include "services/tracker/core/phd/assignment.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking::phd {

Assignment::Assignment(const Parameters& parameters, const Capacity& c)
    : parameters_(parameters), sets_(c.group_measurements) {
  assigned_.reserve(c.group_measurements);
  assigned_object_.reserve(c.group_measurements);
  objects_.reserve(c.group_components);
  shares_.reserve(c.group_measurements * c.group_components);
  order_.reserve(c.group_measurements);
  starts_.reserve(c.group_measurements + 1);
  starts_.assign(1, 0);
  block_labels_.reserve(c.group_measurements);
  block_shares_.reserve(c.group_measurements * c.group_components);
}

void Assignment::find(const Model& model, std::span<const Measurement<double>> measurements,
                      std::span<const Predicted> components, std::span<const Prediction<double>> predictions) {
  assign(measurements, components, predictions);
  find_blocks(model, measurements);
}

void Assignment::assign(std::span<const Measurement<double>> z, std::span<const Predicted> components,
                        std::span<const Prediction<double>> predictions) {
  objects_.clear();
  for (const Predicted& c : components) {
    const bool is_known = std::find(objects_.begin(), objects_.end(), c.identity) != objects_.end();
    if (c.is_object && !is_known) objects_.push_back(c.identity);
  }
  const std::size_t columns = objects_.size();
  assigned_.assign(z.size(), Partitions::kNone);
  assigned_object_.assign(z.size(), Partitions::kNone);
  shares_.assign(z.size() * columns, 0.0);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const std::span<double> shares{shares_.data() + i * columns, columns};
    double best = -kInfinity, sum = 1.0;  // clutter is 1
    for (std::size_t j = 0; j < components.size(); ++j) {
      const Predicted& c = components[j];
      const Prediction<double>& p = predictions[j];
      if (!is_seen(p) || p.place_distance(z[i].position_m) > parameters_.gate_chi2 ||
          p.range_rate_distance(z[i]) > parameters_.gate_chi2) {
        continue;
      }
      const double log_intensity = p.log_intensity(z[i]);
      // Each measurement to the identity with the largest predicted intensity.
      if (c.log_weight + log_intensity > best) {
        best = c.log_weight + log_intensity;
        assigned_[i] = static_cast<std::int16_t>(c.identity);
      }
      // Objects share it by their intensities, given that they exist.
      if (!c.is_object) continue;
      const auto column = std::find(objects_.begin(), objects_.end(), c.identity) - objects_.begin();
      const double intensity = c.share * std::exp(log_intensity);
      shares[static_cast<std::size_t>(column)] += intensity;
      sum += intensity;
    }
    double most = 0.0;
    for (std::size_t k = 0; k < columns; ++k) {
      shares[k] = shares[k] < parameters_.min_share * sum ? 0.0 : shares[k] / sum;
      if (shares[k] <= most) continue;
      most = shares[k];
      assigned_object_[i] = static_cast<std::int16_t>(k);
    }
  }
}

void Assignment::find_blocks(const Model& model, std::span<const Measurement<double>> z) {
  // Measurements that share a cell in one of the coarsest partitions are in one block.
  const std::size_t n = z.size();
  sets_.reset(n);
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      const bool is_one_object = assigned_[a] != Partitions::kNone && assigned_[a] == assigned_[b];
      if (is_one_object || model.are_linked(z[a], z[b])) sets_.join(a, b);
    }
  }
  for (std::size_t k = 0; k < objects_.size(); ++k) {
    std::size_t first = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (shares_[i * objects_.size() + k] <= 0.0) continue;
      if (first == n) first = i;
      sets_.join(first, i);
    }
  }
  order_.clear();
  starts_.clear();
  for (std::size_t i = 0; i < n; ++i) order_.push_back(i);
  std::sort(order_.begin(), order_.end(), [this](std::size_t a, std::size_t b) {
    const std::size_t root_a = sets_.root(a), root_b = sets_.root(b);
    return root_a != root_b ? root_a < root_b : a < b;
  });
  for (std::size_t k = 0; k < n; ++k) {
    if (k == 0 || sets_.root(order_[k]) != sets_.root(order_[k - 1])) starts_.push_back(k);
  }
  starts_.push_back(n);
}

void Assignment::add_partitions(const Model& model, std::size_t index, Partitions& partitions) {
  block_labels_.clear();
  block_shares_.clear();
  for (const std::size_t i : block(index)) {
    block_labels_.push_back(assigned_object_[i]);
    const double* shares = shares_.data() + i * objects_.size();
    block_shares_.insert(block_shares_.end(), shares, shares + objects_.size());
  }
  // The first is weighed even when the work budget is spent: it makes no new objects of clutter.
  partitions.add_predicted(model, block_labels_, Rest::kAlone);
  for (const Rest rest : {Rest::kAlone, Rest::kLinked}) {
    partitions.add_shared(model, block_labels_, block_shares_, objects_.size(), rest);
  }
  block_labels_.clear();
  for (const std::size_t i : block(index)) block_labels_.push_back(assigned_[i]);
  for (const Rest rest : {Rest::kAlone, Rest::kLinked}) partitions.add_predicted(model, block_labels_, rest);
}

}  // namespace boresight::tracking::phd
