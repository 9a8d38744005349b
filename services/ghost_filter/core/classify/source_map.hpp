// Where there may be something that a detection is of, or mirrors: objects and recent movers, as bits in the cells of a
// coarse grid about the vehicle. What lies within reach of a place is found by one look-up, however many there are.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace boresight::ghosts {

class SourceMap {
 public:
  /// One for each object (several share one where there are many), one for all movers.
  using Bits = std::uint64_t;
  static constexpr Bits kAll = ~Bits{0};
  SourceMap();
  void clear();
  /// An object that can be found within ± `half_m` of its centre, along x and y; vehicle frame. Not finite: everywhere.
  void enter_object(std::uint32_t index, const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m);
  void enter_mover(const Eigen::Vector2d& place_m, double reach_m);
  /// All that may be found within `reach_m` of a place along x and y, and some more; not finite, or a large reach: all.
  [[nodiscard]] Bits about(const Eigen::Vector2d& place_m, double reach_m) const;
  [[nodiscard]] static bool has_movers(Bits bits) { return (bits & kMovers) != 0; }
  /// Calls `visit(index)` for the objects, of `count`.
  template <typename Visit>
  static void visit_objects(Bits bits, std::uint32_t count, const Visit& visit) {
    // Where all may be, only those are asked for that there are.
    for (Bits left = bits & (count < kObjectBits ? (Bits{1} << count) - 1 : ~kMovers); left != 0; left &= left - 1) {
      for (auto i = static_cast<std::uint32_t>(std::countr_zero(left)); i < count; i += kObjectBits) visit(i);
    }
  }

 private:
  static constexpr std::uint32_t kObjectBits = 63;
  static constexpr Bits kMovers = Bits{1} << kObjectBits;
  static constexpr double kCell_m = 8.0;
  static constexpr std::int32_t kCells = 48;  // across; what is beyond is taken to be in the cells at the edge
  /// Each reach asked for has a grid of its own, in which all are entered as much larger.
  static constexpr std::array<double, 4> kReaches_m{2.5, 5.0, 10.0, 20.0};
  struct Cells {
    std::int32_t left, right, bottom, top;
  };
  [[nodiscard]] static std::int32_t cell_of(double coordinate_m);
  [[nodiscard]] static Cells cells_of(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m);
  [[nodiscard]] static Bits bits_between(std::int32_t first, std::int32_t last) {
    static_assert(kCells < 64);
    return (Bits{2} << last) - (Bits{1} << first);
  }
  [[nodiscard]] Bits* row_of(std::size_t level, std::int32_t row) {
    return objects_.data() + (level * kCells + static_cast<std::size_t>(row)) * kCells;
  }
  std::vector<Bits> objects_;                   // by reach, row, column
  std::array<Bits, kReaches_m.size()> rows_{};  // of those, by reach: a bit for each in which there is something
  std::vector<Bits> movers_;                    // by reach and row: a bit for each column
};

}  // namespace boresight::ghosts
