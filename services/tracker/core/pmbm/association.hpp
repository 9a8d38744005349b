// Association within a group: which measurements are of which object, which are the first of a new one, which are
// clutter. Coordinate ascent on the collapsed joint likelihood and moves of whole cells find the likely associations;
// in each, the measurements are then shared softly by leave-one-out predictive weights (algorithms.md 3.1.1, points 3
// and 4).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/pmbm/group.hpp"
#include "services/tracker/core/pmbm/parameters.hpp"
#include "services/tracker/core/pmbm/poisson_part.hpp"

namespace boresight::tracking::pmbm {

/// One association of a row of the group. Cells 0 … objects − 1 are those of the row's objects, then those of new ones.
struct Candidate {
  double log_weight = 0.0;
  std::uint64_t key = 0;  ///< of row and hard association
  std::size_t row = 0, objects = 0;
  std::vector<std::int16_t> labels;  ///< cell of each measurement, −1: clutter or the first of a new object alone
  std::vector<Cell<double>> cells;   ///< softly shared; `key` is that of the hard cell
};

class Association {
 public:
  Association(const Parameters& parameters, const Capacity& capacity);

  /// Finds the likely associations of a group with its measurements, the likeliest first. `work` counts likelihood
  /// evaluations against the budget.
  std::span<const Candidate> search(Model& model, PoissonPart& poisson, const Group& group,
                                    std::span<const Measurement<double>> measurements,
                                    std::span<const std::uint64_t> keys, std::uint32_t& work);

  /// Of the group last searched: prediction of a local hypothesis.
  [[nodiscard]] Prediction<double>& prediction(std::size_t local) { return predictions_[local]; }
  /// log of the intensity of a new object for a measurement alone, and log(1 + that).
  [[nodiscard]] double log_new(std::size_t z) const { return log_new_[z]; }
  [[nodiscard]] double log_alone(std::size_t z) const { return log_alone_[z]; }

 private:
  /// A hard association in work.
  struct State {
    std::vector<std::int16_t> labels;
    std::vector<Cell<double>> cells;
    std::vector<double> values;  // log of each cell
    std::size_t objects = 0;
    double score = 0.0;
  };
  struct Remembered {
    std::uint64_t key = 0;
    double value = 0.0;
  };

  void reserve(State& state, const Capacity& capacity) const;
  void prepare(Model& model, PoissonPart& poisson, const Group& group);
  void start(State& state) const;
  void search_row(std::size_t row, double log_weight);
  void ascend(State& state);
  void compact(State& state);
  void rescore(State& state);
  void cluster_rest(State& state);
  /// Cells of new objects that are likelier to be nothing but clutter become that.
  void dissolve_unlikely(State& state);
  bool split(const State& state, std::size_t cell);
  void consider(State& trial, std::size_t row, double log_weight);
  void move_cells(std::size_t cell, std::size_t row, double log_weight);
  void keep(const State& state, std::size_t row, double log_weight);
  double soften(const State& state, std::vector<Cell<double>>& out);
  [[nodiscard]] double cell_value(const State& state, std::size_t cell, const Cell<double>& content);
  [[nodiscard]] double object_value(std::size_t object, const Cell<double>& content);
  [[nodiscard]] double new_value(const Cell<double>& content);
  [[nodiscard]] bool is_allowed(const State& state, std::size_t z, std::size_t cell) const;
  [[nodiscard]] double dissolved(const State& state, std::size_t cell) const;
  [[nodiscard]] bool is_spent() const { return *work_ > parameters_.work_budget; }
  template <typename Compute>
  double remembered(const Cell<double>& content, std::size_t source, const Compute& compute);

  Parameters parameters_;
  Capacity capacity_;
  std::size_t max_cells_;

  // The problem.
  Model* model_ = nullptr;
  PoissonPart* poisson_ = nullptr;
  const Group* group_ = nullptr;
  std::span<const Measurement<double>> z_;
  std::span<const std::uint64_t> keys_;
  std::uint32_t* work_ = nullptr;
  std::vector<Prediction<double>> predictions_;     // of the pool
  std::vector<double> log_existence_, log_missed_;  // of the pool
  std::vector<double> existence_;                   // as an object, over all rows
  std::vector<char> gated_;                         // pool × measurements
  std::vector<double> log_new_, log_alone_;         // of the measurements
  std::vector<std::size_t> locals_;                 // of the row's objects

  // The search.
  State state_, best_, trial_, second_;
  bool improved_ = false;
  std::vector<Cell<double>> old_cells_;
  std::vector<std::size_t> side_a_, side_b_, members_;
  std::vector<char> done_;
  std::vector<Candidate> candidates_;
  std::size_t number_of_candidates_ = 0;
  FixedTable known_;
  std::vector<Remembered> memory_;
  std::uint64_t salt_ = 1;
  std::vector<double> share_, next_share_, gain_;
  std::vector<Cell<double>> soft_;
  std::vector<char> is_shared_;
  std::vector<std::int16_t> renamed_;
};

}  // namespace boresight::tracking::pmbm
