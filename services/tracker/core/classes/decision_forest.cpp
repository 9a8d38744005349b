#include "services/tracker/core/classes/decision_forest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

[[nodiscard]] bool are_shares(const auto& values) {
  double sum = 0.0;
  for (const auto value : values) {
    if (!(value >= 0)) return false;
    sum += static_cast<double>(value);
  }
  return std::abs(sum - 1.0) <=
         static_cast<double>(values.size()) * static_cast<double>(std::numeric_limits<float>::epsilon());
}

void expect(bool holds, const char* problem) {
  if (!holds) throw std::invalid_argument(problem);
}

void check(const ForestTable& table) {
  for (const float value : table.missing) expect(std::isfinite(value), "a value of an unknown feature is not finite");
  expect(table.exponent > 0.0 && std::isfinite(table.exponent), "the exponent must be positive");
  expect(are_shares(table.prior_share), "the prior shares of the classes must sum to 1");
  for (const auto& leaf : table.leaves) expect(are_shares(leaf), "the probabilities of a leaf must sum to 1");
  for (const std::uint32_t tree : table.trees) expect(tree < table.nodes.size(), "a tree begins behind the last node");
  for (std::size_t i = 0; i < table.nodes.size(); ++i) {
    const ForestNode& node = table.nodes[i];
    if (node.feature == ForestNode::kLeaf) {
      expect(node.other < table.leaves.size(), "a leaf has no probabilities");
      continue;
    }
    expect(node.feature < table.missing.size(), "a node asks for an unknown feature");
    expect(std::isfinite(node.threshold), "a threshold is not finite");
    // Each walk goes forward, so it ends.
    expect(i + 1 < table.nodes.size() && node.other > i && node.other < table.nodes.size(),
           "a node has a child that is not behind it");
  }
}

}  // namespace

DecisionForest::DecisionForest(ForestTable table) : table_(std::move(table)) {
  check(table_);
}

const std::array<float, extended_object::kRoadUserClasses>& DecisionForest::leaf(
    std::uint32_t node, std::span<const double> features) const {
  while (table_.nodes[node].feature != ForestNode::kLeaf) {
    const ForestNode& at = table_.nodes[node];
    const double known = at.feature < features.size() ? features[at.feature] : NAN;
    const float value = std::isfinite(known) ? static_cast<float>(known) : table_.missing[at.feature];
    node = value <= at.threshold ? node + 1 : at.other;
  }
  return table_.leaves[table_.nodes[node].other];
}

ClassProbabilities DecisionForest::probabilities(std::span<const double> features) const {
  if (table_.trees.empty()) return table_.prior_share;
  ClassProbabilities p{};
  for (const std::uint32_t tree : table_.trees) {
    const auto& of_tree = leaf(tree, features);
    for (std::size_t k = 0; k < p.size(); ++k) p[k] += static_cast<double>(of_tree[k]);
  }
  const auto trees = static_cast<double>(table_.trees.size());
  for (double& share : p) share = std::pow(std::max(share / trees, kLeastProbability), table_.exponent);
  const double sum = std::accumulate(p.begin(), p.end(), 0.0);
  for (double& share : p) share /= sum;
  return p;
}

}  // namespace boresight::tracking
