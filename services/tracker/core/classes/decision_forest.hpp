// A forest of decision trees (Breiman 2001): each tree asks one feature after the other and ends at a leaf with the
// probabilities of the classes. The forest's probabilities are the mean over its trees, sharpened or blunted by one
// exponent that was learnt on drives which the trees do not know:
//
//     p_k ∝ ( Σ_t p_{k,t} / T )^exponent
//
// A feature that is not known has the value that the table states for it: the trees were grown with the same.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "services/tracker/core/classes/object_forest.hpp"

namespace boresight::tracking {

class DecisionForest {
 public:
  /// Without trees the probabilities are the prior's. Throws std::invalid_argument for a table that cannot be
  /// evaluated: an index out of its range, a walk that does not end, probabilities that do not sum to 1.
  explicit DecisionForest(ForestTable table);

  /// `features`: as many as the table has. They sum to 1. Does not allocate.
  [[nodiscard]] ClassProbabilities probabilities(std::span<const double> features) const;
  [[nodiscard]] const ForestTable& table() const { return table_; }

 private:
  [[nodiscard]] const std::array<float, extended_object::kRoadUserClasses>& leaf(
      std::uint32_t node, std::span<const double> features) const;
  ForestTable table_;
};

}  // namespace boresight::tracking
