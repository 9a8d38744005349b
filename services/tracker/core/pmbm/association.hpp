// Association within a group: which measurements are of which object, which are the first of a new one, which are
// clutter. Coordinate ascent on the collapsed joint likelihood and moves of whole cells (cell_moves.cpp) find the
// likely associations; in each, the measurements are then shared softly by leave-one-out predictive weights
// (soft_association.cpp; algorithms.md 3.1.1, points 3 and 4).
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/pmbm/cell_memory.hpp"
#include "services/tracker/core/pmbm/group.hpp"
#include "services/tracker/core/pmbm/parameters.hpp"
#include "services/tracker/core/pmbm/poisson_part.hpp"
#include "services/tracker/core/pmbm/row_gates.hpp"

namespace boresight::tracking::pmbm {

/// Cells 0 … objects − 1 are those of a row's objects, then those of new ones.
struct Cells {
  std::size_t objects = 0;
  std::vector<std::int16_t> labels;  ///< cell of each measurement, −1: clutter or the first of a new object alone
  std::vector<Cell<double>> cells;
};

/// An association of a row of the group. Its cells are softly shared; their `key` is that of the hard cell.
struct Candidate : Cells {
  double log_hard = 0.0;    ///< weight of the hard association
  double log_weight = 0.0;  ///< with that of the associations which differ from it in shared measurements
  std::uint64_t key = 0;    ///< of row and hard association
  std::size_t row = 0;
  std::vector<double> shared;  ///< of each cell: share of its measurements that other cells have
};

class Association {
 public:
  Association(const Parameters& parameters, const Capacity& capacity);

  /// Finds the likely associations of a group with its measurements, the likeliest first. `work` counts likelihood
  /// evaluations against the budget.
  std::span<const Candidate> search(Model& model, PoissonPart& poisson, const Group& group,
                                    std::span<const Measurement<double>> measurements,
                                    std::span<const std::uint64_t> keys, std::uint32_t& work);

  /// Whether a search ended at its budget since the last call of this.
  [[nodiscard]] bool take_was_cut() { return std::exchange(was_cut_, false); }

  /// Of the group last searched: prediction of a local hypothesis.
  [[nodiscard]] Prediction<double>& prediction(std::size_t local) { return predictions_[local]; }
  /// Whether a measurement is in the gate of a local hypothesis and belongs to a cell of the candidate.
  [[nodiscard]] bool is_taken(const Candidate& candidate, std::size_t local, std::size_t z) const {
    return gated_[local * z_.size() + z] != 0 && candidate.labels[z] >= 0;
  }
  /// log of the intensity of a new object for a measurement alone, and log(1 + that).
  [[nodiscard]] double log_new(std::size_t z) const { return log_new_[z]; }
  [[nodiscard]] double log_alone(std::size_t z) const { return log_alone_[z]; }

 private:
  /// A hard association in work.
  struct State : Cells {
    std::vector<double> values;  // log of each cell
    double score = 0.0;
  };

  void reserve(Cells& cells) const;
  void prepare(Model& model, PoissonPart& poisson, const Group& group);
  void take_row(std::size_t row);
  void find_gates();

  // Likelihoods.
  [[nodiscard]] double cell_value(const Cells& cells, std::size_t cell, const Cell<double>& content);
  [[nodiscard]] double object_value(std::size_t object, const Cell<double>& content);
  [[nodiscard]] double new_value(const Cell<double>& content);
  [[nodiscard]] double dissolved(const State& state, std::size_t cell) const;
  /// Visits the cells that may take a measurement, in their order: of objects with it in the gate, of new ones near it.
  template <typename Visit>
  void for_allowed(const Cells& cells, std::size_t z, const Visit& visit) const;
  void rescore(State& state);
  void sum_changed(State& state) const;
  [[nodiscard]] Cell<double> sum_of(std::span<const std::size_t> measurements) const;

  // Start of a row, and ascent by single measurements.
  void find_starts();
  void start(State& state) const;
  void cluster_rest(State& state);
  void ascend(State& state);
  void compact(State& state);

  // Moves of whole cells.
  void search_row();
  void move_cell(std::size_t cell);
  void split_cell(std::size_t cell);
  bool split(const State& state, std::size_t cell);
  void exchange_cells(std::size_t cell);
  void relabel(std::size_t from, std::int16_t to);
  void consider(State& trial);
  void dissolve_unlikely(State& state);
  void keep_alternatives();

  // Candidates.
  void keep(const State& state);
  [[nodiscard]] std::size_t prune(std::size_t number);
  double share_hard(const Cells& hard);
  void share_again(const Cells& hard);
  [[nodiscard]] double normalise_shares(std::size_t z);
  void gather_shares();
  void soften(Candidate& candidate);

  [[nodiscard]] bool is_spent() {
    const bool spent = *work_ > search_limit_;
    was_cut_ = was_cut_ || spent;
    return spent;
  }

  Parameters parameters_;
  Capacity capacity_;
  std::size_t max_cells_;
  double log_min_share_;

  // The problem.
  Model* model_ = nullptr;
  PoissonPart* poisson_ = nullptr;
  const Group* group_ = nullptr;
  std::span<const Measurement<double>> z_;
  std::span<const std::uint64_t> keys_;
  std::uint32_t* work_ = nullptr;
  bool was_cut_ = false;
  std::uint32_t search_limit_ = 0;                  // of work_; the rest is left to sharing
  std::vector<Prediction<double>> predictions_;     // of the pool
  std::vector<double> log_existence_, log_missed_;  // of the pool
  std::vector<double> existence_;                   // as an object, over all rows
  std::vector<char> gated_;                         // pool × measurements
  std::vector<double> log_new_, log_alone_;         // of the measurements

  // The row.
  std::size_t row_ = 0;
  double log_row_ = 0.0;             // its weight
  std::vector<std::size_t> locals_;  // of its objects
  RowGates gates_;                   // of all rows

  // The search.
  std::vector<Candidate> starts_;  // of the rows
  std::size_t number_of_starts_ = 0;
  double log_top_ = 0.0;  // of the likeliest hard association so far
  State state_, best_, trial_;
  bool improved_ = false;
  /// What tells cells of measurements apart.
  struct Content {
    std::uint64_t key = 0;
    double n = 0.0;
  };
  std::vector<Content> contents_;
  std::vector<char> changed_;  // of the cells of a state
  std::vector<std::size_t> side_a_, side_b_, members_;
  std::vector<char> done_;
  std::vector<Candidate> candidates_;
  std::size_t number_of_candidates_ = 0;
  FixedTable known_;
  CellMemory memory_, soft_memory_;         // of hard and of softly shared cells
  std::vector<std::uint64_t> source_keys_;  // of the pool, for memory_
  // Shares of an association: each measurement has links to the cells that may have it, and then to clutter.
  std::vector<std::size_t> first_link_, own_link_;  // of the measurements; to the cell of the hard association
  std::vector<std::size_t> linked_;                 // of the links: cell; clutter is the number of cells
  std::vector<double> share_, next_share_;          // of the links, with room for all
  std::vector<double> gain_;                        // of the links of one measurement
  std::vector<Cell<double>> soft_;
  std::vector<double> soft_values_;
  std::vector<char> is_shared_;
  std::vector<std::int16_t> renamed_;
};

template <typename Visit>
void Association::for_allowed(const Cells& s, std::size_t z, const Visit& visit) const {
  gates_.for_objects(row_, z, visit);
  const double reach_m = 2.0 * model_->link_distance_m();
  for (std::size_t b = s.objects; b < s.cells.size(); ++b) {
    const Cell<double>& c = s.cells[b];
    if (c.n != 0.0 && squared_norm(c.mean() - z_[z].position_m) < reach_m * reach_m) visit(b);
  }
}

/// Logs below it count as it: a difference of two of them is then a number.
inline constexpr double kLeastLog = -1e4;
/// A log that is larger by less is not: the search would exchange equals for ever.
inline constexpr double kRounding = 1e-6;

}  // namespace boresight::tracking::pmbm
