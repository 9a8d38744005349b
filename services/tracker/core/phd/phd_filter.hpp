// GGIW-PHD filter (Mahler 2009; Granström and Orguner 2012): the intensity of objects as a mixture of weighted
// components. With p_S the probability of survival, q that of no detection, L_j(W) the likelihood of the cell W under
// component j over its clutter densities, w_j the predicted weights and f_j the predicted components:
//   D₋(x) = ∫ p_S(x′) f(x | x′) D(x′) dx′ + births                                        (1) prediction
//   D(x)  = Σ_j q_j w_j f_j(x) + Σ_p ω_p Σ_{W ∈ p} Σ_j w_j L_j(W) / d_W · f_j(x | W)      (2) correction
//   ω_p   = Π_{W ∈ p} d_W / Σ_p′ Π_{W ∈ p′} d_W                                           (3) weight of a partition
//   d_W   = [|W| = 1] + Σ_j w_j L_j(W)                                                    (4) weight of a cell
// Where two blocks of measurements share no cell in any partition, the products of (3) separate. So each block is
// partitioned alone, and all combinations count:
//   ω_{p × p′} = ω_p ω_p′                                                                 (5)
// A Poisson intensity does not know that a component is one object: it also keeps what has been detected as not
// detected, and one scan without detection lowers a weight to q: the next detections then go to another object nearby.
// So the filter goes beyond the papers: an identity, the components that descend from one newborn component, is one
// object. Its weights sum to the probability r that it exists. With a the expected number of its detected components,
// at most 1, r is that of a Bernoulli component (Musicki, Evans and Stankovic 1994), and the first sum of (2) becomes
// (7); then the weights of each identity are scaled to sum r:
//   r = a + (1 − a) r₋ q / (1 − r₋ + r₋ q),  r₋ = Σ_j w_j                                 (6)
//   Σ_j (1 − a) q_j w_j f_j / (1 − r₋ + r₋ q_j)                                           (7)
// With Parameters::as_published, the sum is that of (2), and the existence of an estimate is min(Σ w, 1).
#pragma once

#include <cstdint>
#include <vector>

#include "services/tracker/core/filter.hpp"
#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/phd/assignment.hpp"
#include "services/tracker/core/phd/parameters.hpp"
#include "services/tracker/core/phd/partitions.hpp"
#include "services/tracker/core/pmbm/group.hpp"
#include "services/tracker/core/pmbm/grouping.hpp"
#include "services/tracker/core/pmbm/poisson_part.hpp"

namespace boresight::tracking::phd {

class PhdFilter final : public Filter {
 public:
  PhdFilter(const Parameters& parameters, const Capacity& capacity);

  void step(Model& model, double elapsed_s) override;
  void clear() override;
  [[nodiscard]] std::span<const ObjectEstimate> estimates() const override { return estimates_; }
  [[nodiscard]] std::span<const double> explained() const override { return explained_; }
  [[nodiscard]] const FilterWork& work() const override { return work_; }

  /// Expected number of objects that have been detected: the sum of the weights, births apart.
  [[nodiscard]] double cardinality() const;

 private:
  static constexpr std::uint32_t kNew = 0;  ///< identity of a newborn component
  struct Hypothesis {
    std::uint32_t id = 0;
    pmbm::LocalHypothesis local;  ///< `existence` is the weight
  };
  /// The components of one identity are hypotheses about one object.
  struct Identity {
    std::uint32_t id = 0;
    double existence = 0.0;  ///< r
    double weight = 0.0;     ///< Σ w; r, unless as published
    double missed = 0.0;     ///< Σ q w
    double detected = 0.0;   ///< a
  };

  void predict(const Model& model, double elapsed_s);
  void begin_group(Model& model, const pmbm::WorkItem& item);
  void partition(const Model& model, std::size_t block);
  void weigh_partitions(Model& model);
  void weigh_cell(Model& model, std::size_t cell);
  void correct_detected(Model& model, std::size_t block);
  void correct_missed();
  void reduce();
  void add_child(const Hypothesis& child);
  /// Whether components may become one: not if their identities are two objects.
  [[nodiscard]] bool may_merge(const Hypothesis& a, const Hypothesis& b) const;
  void identify();
  [[nodiscard]] bool is_object(std::uint32_t id) const;
  void report();
  [[nodiscard]] Identity& identity_of(std::size_t component) { return identities_[predicted_[component].identity]; }

  Parameters parameters_;
  Capacity capacity_;
  pmbm::PoissonPart poisson_;  // births that nothing has detected yet; they connect no groups
  pmbm::GroupStore store_;     // the components, each a group of its own
  pmbm::Grouping grouping_;
  Assignment assignment_;
  Partitions partitions_;
  std::vector<std::uint64_t> keys_;
  std::vector<Identity> identities_, next_identities_;
  FixedTable identity_index_, next_index_;  // id → index
  std::vector<std::size_t> heaviest_;       // component of each identity, in the store
  std::vector<Hypothesis> corrected_;       // of all groups

  // The group: predicted components, measurements, corrected components.
  std::vector<Component<double>> components_;
  std::vector<Predicted> predicted_;
  std::vector<Prediction<double>> predictions_;
  std::vector<double> existence_;
  std::vector<Measurement<double>> z_;
  std::vector<std::size_t> scan_index_;
  std::vector<Hypothesis> children_;

  // The block.
  std::vector<Measurement<double>> block_z_;
  std::vector<std::uint64_t> block_keys_;
  std::vector<double> log_terms_;  // cells × (components and births): log w_j L_j(W)
  std::vector<double> log_d_;      // of the cells
  std::vector<double> omega_;      // of the partitions
  std::vector<double> cell_probability_, cell_explained_;

  std::vector<std::size_t> by_weight_;              // scratch
  std::vector<char> is_merged_;                     // scratch
  std::vector<WeightedComponent<double>> mixture_;  // scratch
  std::vector<ObjectEstimate> estimates_;
  std::vector<double> explained_;
  FilterWork work_;
  std::uint32_t next_id_ = 1;
};

}  // namespace boresight::tracking::phd
