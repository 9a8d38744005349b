// A group: objects whose detections may be mixed up, with their global hypotheses. Groups are independent.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/ggiw/component.hpp"
#include "services/tracker/core/pmbm/parameters.hpp"

namespace boresight::tracking::pmbm {

/// Room for local hypotheses of a group in work.
[[nodiscard]] constexpr std::size_t group_pool(const Capacity& c) {
  constexpr std::size_t kMost = std::numeric_limits<std::int16_t>::max();  // a table names them by 16 bits
  return std::min({c.group_objects * c.candidates, c.local_hypotheses, kMost});
}

/// One hypothesis about one object: a Bernoulli component.
struct LocalHypothesis {
  double existence = 0.0;
  double detections = 0.0;     ///< in the latest scan
  Symmetric2<double> scatter;  ///< of these about their mean, m²
  Component<double> component;
  Vector2<double> mean_m{};  ///< of the detections
  double shared = 0.0;       ///< as of ObjectEstimate
};

/// A global hypothesis (row) names for each object (column) one local hypothesis of the pool, or none (−1).
struct Group {
  std::vector<std::uint32_t> ids;
  std::vector<LocalHypothesis> pool;
  std::vector<double> log_weights;  // of the rows
  std::vector<std::int16_t> table;  // rows × stride
  std::size_t stride = 0;           // room for columns
  FixedTable alike;                 // scratch: pairs of the pool

  explicit Group(const Capacity& capacity);
  void clear();
  [[nodiscard]] std::size_t rows() const { return log_weights.size(); }
  [[nodiscard]] std::size_t columns() const { return ids.size(); }
  [[nodiscard]] std::int16_t& at(std::size_t row, std::size_t column) { return table[row * stride + column]; }
  [[nodiscard]] std::int16_t at(std::size_t row, std::size_t column) const { return table[row * stride + column]; }
  /// A row of nothing; false if there is no room.
  bool add_row(double log_weight);
  /// A column, empty in all rows; false if there is no room.
  bool add_column(std::uint32_t id);
  /// Index in the pool, or −1 if there is no room.
  [[nodiscard]] int add_local(const LocalHypothesis& local);
  void erase_row(std::size_t row);
  /// Weights to sum 1.
  void normalise();
  /// Probability that the object exists.
  [[nodiscard]] double existence(std::size_t column) const;

  // Steps of the reduction, in their order.
  /// Rows that name the same hypotheses are one.
  void join_equal_rows();
  /// Rows that differ only in hypotheses alike, or in the existence of one object, are one (merged by moments).
  void merge_similar_rows(double merge_distance);
  /// Rows below `prune_weight` and beyond the `most` likeliest are dropped.
  void prune_rows(double prune_weight, std::size_t most);
};

/// All groups between two scans, in one block of memory.
class GroupStore {
 public:
  explicit GroupStore(const Capacity& capacity);
  void clear();
  [[nodiscard]] std::size_t size() const { return spans_.size(); }

  /// Views of a stored group.
  [[nodiscard]] std::span<LocalHypothesis> pool(std::size_t group);
  [[nodiscard]] std::span<const LocalHypothesis> pool(std::size_t group) const;
  [[nodiscard]] std::span<const std::uint32_t> ids(std::size_t group) const;
  [[nodiscard]] std::span<const double> log_weights(std::size_t group) const;
  [[nodiscard]] std::int16_t at(std::size_t group, std::size_t row, std::size_t column) const;

  /// Whether a group is one object in one row.
  [[nodiscard]] bool is_single(std::size_t group) const {
    return spans_[group].columns == 1 && spans_[group].rows == 1;
  }
  /// The object is in no row any more.
  void erase(std::size_t group, std::size_t column);
  void rename(std::size_t group, std::size_t column, std::uint32_t id) { ids_[spans_[group].ids + column] = id; }

  /// Stores the columns `columns` of a group, with the locals that their rows name; false if there is no room.
  bool store(const Group& group, std::span<const std::size_t> columns);
  /// Stores an object that is the same in all rows, as a group of its own.
  bool store_alone(std::uint32_t id, const LocalHypothesis& local);
  /// Multiplies a group of the workspace by a stored one; at most `most` rows are kept. False if there is no room.
  bool join_into(Group& group, std::size_t stored, std::size_t most);

 private:
  struct Span {
    std::size_t ids, columns, pool, locals, weights, rows, table;
  };
  Capacity capacity_;
  std::vector<Span> spans_;
  std::vector<std::uint32_t> ids_;
  std::vector<LocalHypothesis> pool_;
  std::vector<double> log_weights_;
  std::vector<std::int16_t> table_;
  std::vector<int> renamed_;  // scratch: pool index → stored index
  struct Product {
    double log_weight;
    std::size_t first, second;
  };
  std::vector<Product> products_;        // scratch
  std::vector<std::int16_t> old_table_;  // scratch
};

}  // namespace boresight::tracking::pmbm
