// Which places of a scan hold detections, so that what is expected elsewhere need not be worked out.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace boresight::ghosts {

/// A grid that repeats every 512 m: a place may also seem occupied by a detection that far away.
class OccupiedPlaces {
 public:
  void add(const Eigen::Vector2d& place_m) { rows_[row(place_m.y())] |= column_bit(place_m.x()); }
  /// Whether a detection may be within `half_width_m` of a place; true also if that is so by the width of a cell only.
  [[nodiscard]] bool may_hold(const Eigen::Vector2d& place_m, double half_width_m) const {
    const int columns = cell(place_m.x() + half_width_m) - cell(place_m.x() - half_width_m) + 1;
    const int number_of_rows = cell(place_m.y() + half_width_m) - cell(place_m.y() - half_width_m) + 1;
    if (columns >= kCells || number_of_rows >= kCells) return true;
    const std::uint64_t wanted =
        std::rotl((std::uint64_t{1} << static_cast<unsigned>(columns)) - 1U, cell(place_m.x() - half_width_m));
    for (int k = 0; k < number_of_rows; ++k) {
      if ((rows_[(row(place_m.y() - half_width_m) + static_cast<std::size_t>(k)) % kCells] & wanted) != 0) return true;
    }
    return false;
  }

 private:
  static constexpr int kCells = 64;  // in each direction: the bits of a row
  static constexpr double kCell_m = 8.0;
  /// Rounds down; faster than std::floor without an instruction for it.
  [[nodiscard]] static int cell(double at_m) {
    const double cells = at_m / kCell_m;
    const auto towards_zero = static_cast<int>(cells);
    return towards_zero - (towards_zero > cells ? 1 : 0);
  }
  [[nodiscard]] static std::size_t row(double y_m) { return static_cast<std::size_t>(cell(y_m) & (kCells - 1)); }
  [[nodiscard]] static std::uint64_t column_bit(double x_m) {
    return std::uint64_t{1} << static_cast<unsigned>(cell(x_m) & (kCells - 1));
  }
  std::array<std::uint64_t, kCells> rows_{};
};

}  // namespace boresight::ghosts
