// GGIW-PMBM filter (Granström, Fatemi and Svensson 2020): a Poisson part of objects not detected yet, and groups of
// Bernoulli components with global hypotheses.
#pragma once

#include <cstdint>
#include <vector>

#include "services/tracker/core/filter.hpp"
#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/pmbm/association.hpp"
#include "services/tracker/core/pmbm/group.hpp"
#include "services/tracker/core/pmbm/grouping.hpp"
#include "services/tracker/core/pmbm/parameters.hpp"
#include "services/tracker/core/pmbm/poisson_part.hpp"

namespace boresight::tracking::pmbm {

class PmbmFilter final : public Filter {
 public:
  PmbmFilter(const Parameters& parameters, const Capacity& capacity);

  void step(Model& model, double elapsed_s) override;
  void clear() override;
  [[nodiscard]] std::span<const ObjectEstimate> estimates() const override { return estimates_; }
  [[nodiscard]] std::span<const double> explained() const override { return explained_; }
  [[nodiscard]] const FilterWork& work() const override { return work_; }

 private:
  void predict(const Model& model, double elapsed_s);
  void update(Model& model, const WorkItem& item);
  void update_undetected(Model& model);
  /// The rows of the group after the scan, one for each candidate.
  void make_rows(Model& model, std::span<const Candidate> candidates);
  void add_new_object(Model& model, std::size_t row, const Cell<double>& cell, double existence);
  void note_explained(std::span<const Candidate> candidates, std::span<const std::size_t> measurements);
  void reduce(const Model& model);
  /// Objects that are the same in all rows leave the group.
  void store();
  /// Objects that lie in each other and move alike are parts of one.
  void join_parts(Model& model);
  [[nodiscard]] ObjectEstimate estimate(std::size_t group, std::size_t column);
  void report();

  Parameters parameters_;
  Capacity capacity_;
  PoissonPart poisson_;
  GroupStore current_, next_;
  Grouping grouping_;
  Association association_;
  Group before_, after_;
  std::vector<std::uint64_t> keys_;
  std::vector<Measurement<double>> group_z_;
  std::vector<std::uint64_t> group_keys_;
  FixedTable updated_, new_objects_;  // of the group: local hypothesis and cell → pool; cell → column
  std::vector<int> new_locals_;       // pool index of each column's new object
  std::vector<std::size_t> columns_;  // scratch
  std::vector<double> by_local_;      // scratch
  std::vector<double> by_object_;     // scratch
  std::vector<WeightedComponent<double>> mixture_;
  std::vector<ObjectEstimate> estimates_;
  std::vector<double> explained_;
  struct Likely {
    std::size_t group, column;
    std::uint32_t label;
    const Component<double>* component;
  };
  std::vector<Likely> likely_;  // scratch: objects that exist
  FilterWork work_;
  std::uint32_t next_id_ = 1;
};

}  // namespace boresight::tracking::pmbm
