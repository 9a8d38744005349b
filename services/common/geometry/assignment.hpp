// Least-cost assignment of rows to columns (Jonker & Volgenant's shortest augmenting paths), fixed capacity.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

namespace boresight::geometry {

/// Solves one problem after another without allocation.
class Assignment {
 public:
  static constexpr std::size_t kCapacity = 128;
  static constexpr double kForbidden = std::numeric_limits<double>::infinity();
  static constexpr std::int32_t kNone = -1;

  Assignment();

  /// Begins a problem of `rows` × `columns` (each at most kCapacity) with all pairs forbidden. A row without a
  /// column costs `cost_alone`.
  void reset(std::size_t rows, std::size_t columns, double cost_alone);
  /// Cost of a pair; pairs with a cost above that of an unassigned row are never chosen.
  void set(std::size_t row, std::size_t column, double cost) { cost_[row * stride_ + column] = cost; }
  /// Finds the assignment of least total cost.
  void solve();
  /// Column of a row, or kNone.
  [[nodiscard]] std::int32_t column_of(std::size_t row) const { return column_of_[row]; }
  [[nodiscard]] double total_cost() const { return total_; }

 private:
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  std::size_t stride_ = 0;
  double cost_alone_ = 0.0;
  double total_ = 0.0;
  std::unique_ptr<double[]> cost_;
  std::array<std::int32_t, kCapacity> column_of_{};
};

}  // namespace boresight::geometry
