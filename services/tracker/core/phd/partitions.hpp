// Partitions of measurements into cells: the detections of one object, or one detection of clutter (Granström,
// Lundquist and Orguner 2012; Granström and Orguner 2012). They follow the distances between the measurements, the
// predicted objects, and cells split in two. Each different partition is stored once, each different cell is stored
// once.
//
// Where predicted objects overlap, no single partition is likely, but very many are alike. One shared partition stands
// for them: each measurement is divided among the objects, s_ik to object k and the rest to clutter. Jensen's
// inequality bounds the sum over all assignments from below; with d of a cell (phd_filter.hpp) at the mean C_k = Σ_i
// s_ik z_i:
//   Σ Π_k d(W_k) ≈ exp(Σ_k log d(C_k) + H),  H = − Σ_ik s_ik log s_ik, clutter included
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/phd/parameters.hpp"

namespace boresight::tracking::phd {

/// Sets of indices that are joined step by step.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t capacity) { parents_.reserve(capacity); }
  /// n sets of one index each.
  void reset(std::size_t n);
  [[nodiscard]] std::size_t root(std::size_t index);
  void join(std::size_t a, std::size_t b) { parents_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parents_;
};

/// Measurements that the prediction assigns to no object.
enum class Rest : std::uint8_t {
  kAlone,   ///< each is a cell
  kLinked,  ///< joined by the model's links
};

class Partitions {
 public:
  static constexpr std::int16_t kNone = -1;  ///< no object, no cell

  Partitions(const Parameters& parameters, const Capacity& capacity);

  /// Starts a set of measurements, without partitions. The spans must outlive the work on it.
  void begin(std::span<const Measurement<double>> measurements, std::span<const std::uint64_t> keys);

  /// Measurements of one label form a cell. Labels are below the number of measurements.
  void add(std::span<const std::int16_t> labels);
  /// The prediction partition: measurements of one object form a cell.
  void add_predicted(const Model& model, std::span<const std::int16_t> objects, Rest rest);
  /// The shared partition. `shares` has a row for each measurement and a column for each of `columns` objects. Nothing
  /// is added if hardly any measurement is shared.
  void add_shared(const Model& model, std::span<const std::int16_t> objects, std::span<const double> shares,
                  std::size_t columns, Rest rest);
  /// Single linkage at each different distance from 0 up to the model's link distance, the coarsest first. Where there
  /// are more of them than room, they are spread evenly.
  void add_by_distance(const Model& model);
  /// Repeats each partition with one cell split in two by k-means, where so many detections rather are of two objects.
  /// `expected` gives the expected number of detections of an object at the place of a cell.
  template <typename Expected>
  void add_split(const Expected& expected);

  [[nodiscard]] std::size_t size() const { return partitions_.size(); }
  /// Indices of the cells of a partition.
  [[nodiscard]] std::span<const std::int16_t> cells_of(std::size_t partition) const {
    return {lists_.data() + partitions_[partition].first_cell, partitions_[partition].number_of_cells};
  }
  /// Index of the cell that holds the most of each measurement, or kNone.
  [[nodiscard]] std::span<const std::int16_t> labels(std::size_t partition) const {
    return {labels_.data() + partition * z_.size(), z_.size()};
  }
  /// log of the number of partitions that this one stands for: H.
  [[nodiscard]] double log_count(std::size_t partition) const { return partitions_[partition].log_count; }
  [[nodiscard]] std::span<const Cell<double>> cells() const { return cells_; }

 private:
  struct Partition {
    std::uint64_t key = 0;  // 0: shared
    std::size_t first_cell = 0, number_of_cells = 0;
    double log_count = 0.0;
  };
  struct Link {
    double squared_distance = 0.0;
    std::size_t a = 0, b = 0;
  };
  [[nodiscard]] bool has_room(std::size_t new_cells) const;
  std::int16_t find_or_add(std::uint64_t key);
  void label_by_root();
  void join_predicted(const Model& model, std::span<const std::int16_t> objects, Rest rest);
  void find_tree(const Model& model);
  void split(std::size_t partition, std::int16_t cell);

  Parameters parameters_;
  Capacity capacity_;
  std::span<const Measurement<double>> z_;
  std::span<const std::uint64_t> keys_;
  std::vector<Cell<double>> cells_;
  FixedTable cell_of_key_;
  std::vector<Partition> partitions_;
  std::vector<std::int16_t> lists_;   // cells, partition by partition
  std::vector<std::int16_t> labels_;  // partitions × measurements

  DisjointSets sets_;
  std::vector<Link> tree_;            // of shortest distances
  std::vector<std::size_t> lengths_;  // number of links up to each different length

  // Scratch.
  std::vector<double> nearest_;
  std::vector<std::size_t> via_;
  std::vector<Cell<double>> shared_;
  std::vector<std::uint64_t> label_keys_;
  std::vector<std::int16_t> new_labels_, indices_;
};

template <typename Expected>
void Partitions::add_split(const Expected& expected) {
  for (std::size_t p = 0; p < size(); ++p) {
    if (partitions_[p].key == 0) continue;
    for (std::size_t k = 0; k < partitions_[p].number_of_cells; ++k) {
      const std::int16_t c = cells_of(p)[k];
      const Cell<double>& cell = cells_[static_cast<std::size_t>(c)];
      // Poisson(n; 2γ) > Poisson(n; γ)
      if (cell.n > 1.0 && cell.n * std::numbers::ln2 > expected(cell)) split(p, c);
    }
  }
}

}  // namespace boresight::tracking::phd
