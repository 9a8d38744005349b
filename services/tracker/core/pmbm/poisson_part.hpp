// The Poisson part: objects that exist and have not been detected yet. Births enter it, hypotheses of little existence
// return to it.
#pragma once

#include <span>
#include <vector>

#include "services/tracker/core/ggiw/prediction.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/pmbm/parameters.hpp"

namespace boresight::tracking::pmbm {

class PoissonPart {
 public:
  PoissonPart(const Parameters& parameters, const Capacity& capacity);

  void clear() { components_.clear(); }
  /// Predicts the components and adds the births of the scan; what looks like a birth is merged with it.
  void predict(const Model& model, double elapsed_s);
  /// Prepares the likelihoods of the scan.
  void begin_scan(const Model& model);
  /// After the scan: the components that were not detected, with those that return; the lightest are dropped.
  void end_scan(const Model& model);
  void take_back(double weight, const Component<double>& component);

  /// Whether a measurement may be of one of the components.
  [[nodiscard]] bool is_near(const Measurement<double>& z) const;

  /// The components that count for a group.
  void begin_group(const Model& model, std::span<const Measurement<double>> group);
  /// log of the intensity of undetected objects that give this cell, over its clutter; −inf if there is none.
  [[nodiscard]] double log_likelihood(Model& model, const Cell<double>& cell);
  /// The object that the cell is the first detection of; false if nothing of the Poisson part is near.
  [[nodiscard]] bool first_detected(Model& model, const Cell<double>& cell, Component<double>& out);

 private:
  Parameters parameters_;
  std::vector<PoissonComponent> components_, returned_;
  std::vector<Prediction<double>> predictions_;
  std::vector<double> log_weights_;
  std::vector<std::size_t> near_;            // of the group
  std::vector<Component<double>> detected_;  // scratch
  std::vector<double> log_detected_;         // scratch
  std::vector<WeightedComponent<double>> mixture_;
};

}  // namespace boresight::tracking::pmbm
