// Where there may be something that a detection is of, or mirrors: objects as bits in the columns and in the rows of a
// coarse grid about the vehicle, recent movers in its cells. What lies within reach of a place is found by a few
// look-ups, however many there are.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace boresight::ghosts {

class SourceMap {
 public:
  /// One for each object (several share one where there are many), one for all movers.
  using Bits = std::uint64_t;
  static constexpr Bits kAll = ~Bits{0};
  void clear();
  /// An object that can be found within ± `half_m` of its centre, along x and y; vehicle frame. Not finite: everywhere.
  void enter_object(std::uint32_t index, const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m);
  void enter_mover(const Eigen::Vector2d& place_m, double reach_m);
  /// All that may be found within `reach_m` of a place, along x and along y, and some more; not finite: all; a large
  /// reach along one of them: all that is within reach along the other one. What is seen from afar is known well along
  /// the line of sight only.
  [[nodiscard]] Bits about(const Eigen::Vector2d& place_m, const Eigen::Vector2d& reach_m) const;
  [[nodiscard]] Bits about(const Eigen::Vector2d& place_m, double reach_m) const {
    return about(place_m, Eigen::Vector2d::Constant(reach_m));
  }
  /// The objects of that alone; what stands is asked for no more.
  [[nodiscard]] Bits objects_about(const Eigen::Vector2d& place_m, double reach_m) const {
    const std::size_t level = level_of(reach_m);
    if (level == kReaches_m.size() || !place_m.allFinite()) return kAll;
    return columns_[level][cell_of(place_m.x())] & rows_[level][cell_of(place_m.y())];
  }
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
  static constexpr std::size_t kCells = 48;  // across; what is beyond is taken to be in the cells at the edge
  /// Each reach asked for has a grid of its own, in which all are entered as much larger.
  static constexpr std::array<double, 5> kReaches_m{2.5, 5.0, 10.0, 20.0, 40.0};
  /// Of movers there are more, and what is known worse is near one of them anyway.
  static constexpr std::size_t kMoverReaches = 4;
  struct Cells {
    std::size_t left, right, bottom, top;
  };
  [[nodiscard]] static std::size_t cell_of(double coordinate_m) {
    constexpr double kHalf = 0.5 * kCells;
    const double cells = std::clamp(coordinate_m / kCell_m + kHalf, 0.0, kCells - 1.0);
    return static_cast<std::size_t>(static_cast<std::int32_t>(cells));
  }
  [[nodiscard]] static Cells cells_of(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& half_m);
  [[nodiscard]] static Bits bits_between(std::size_t first, std::size_t last) {
    static_assert(kCells < 64);
    return (Bits{2} << last) - (Bits{1} << first);
  }
  /// The first of the reaches that is as large; their number if none is, or what is asked for is not a number.
  [[nodiscard]] static std::size_t level_of(double reach_m) {
    std::size_t level = 0;
    // Written so that what is not a number has no level.
    while (level < kReaches_m.size() && !(reach_m <= kReaches_m[level])) ++level;
    return level;
  }
  /// Of objects, by reach: in which column, or row, they may be found.
  using Strips = std::array<std::array<Bits, kCells>, kReaches_m.size()>;
  [[nodiscard]] static Bits bits_of(const Strips& strips, double coordinate_m, double reach_m);
  Strips columns_{}, rows_{};
  std::array<std::array<Bits, kCells>, kMoverReaches> movers_{};  // by reach and row: a bit for each column
};

}  // namespace boresight::ghosts
