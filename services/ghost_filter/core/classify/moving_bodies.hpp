// Which tracked objects move, as far as is known, and whether a place lies on one of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/object.hpp"

namespace boresight::ghosts {

class MovingBodies {
 public:
  static constexpr double kAround_m = 0.5;  ///< what seems to be so near to a body is of it
  explicit MovingBodies(std::size_t capacity);

  /// Those of the objects, up to the capacity, that most likely move and rather are there than images. The objects must
  /// outlive what is asked.
  void find(std::span<const Object> objects);
  [[nodiscard]] bool any_at(const Eigen::Vector2d& place_m) const;
  /// Their numbers.
  [[nodiscard]] std::span<const std::uint32_t> numbers() const { return numbers_; }

 private:
  // Bits of the bodies that reach into each strip of the plane, across and along: only what is in both strips of a
  // place needs a look. Strips repeat, so that their number is fixed.
  static constexpr std::int32_t kStrips = 64;
  static constexpr double kStrip_m = 8.0;
  [[nodiscard]] std::uint64_t& bits(std::vector<std::uint64_t>& strips, std::int32_t strip, std::size_t word) const {
    return strips[static_cast<std::size_t>(strip & (kStrips - 1)) * words_ + word];
  }
  void enter(std::vector<std::uint64_t>& strips, std::int32_t first, std::int32_t last, std::size_t body) const;
  std::size_t words_;
  std::span<const Object> objects_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::uint64_t> columns_, rows_;
};

}  // namespace boresight::ghosts
