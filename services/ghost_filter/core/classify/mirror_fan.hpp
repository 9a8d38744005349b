// Which mirrors a line of sight may cross: entered by the directions in which the sensor sees them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/sectors.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"

namespace boresight::ghosts {

class MirrorFan {
 public:
  static constexpr std::size_t kMaxMirrors = 192;
  /// The mirrors beyond kMaxMirrors are not entered. They must outlive what is asked.
  void build(std::span<const Mirror> mirrors, const Eigen::Vector2d& sensor_m);
  /// Calls `visit(mirror)`, in their order, for all that have a point up to most_beyond_m() beyond their ends in this
  /// direction (not zero), and for a few more.
  template <typename Visit>
  void visit(const Eigen::Vector2d& direction, const Visit& visit) const {
    const Bits& bits = sectors_[sector_of<kSectors>(direction)];
    for (std::size_t word = 0; word < bits.size(); ++word) {
      for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
        visit(mirrors_[64 * word + static_cast<std::size_t>(std::countr_zero(left))]);
      }
    }
  }

 private:
  static constexpr std::size_t kSectors = 128;
  using Bits = std::array<std::uint64_t, kMaxMirrors / 64>;
  void enter(std::size_t mirror, const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  std::span<const Mirror> mirrors_;
  std::array<Bits, kSectors> sectors_{};
};

}  // namespace boresight::ghosts
