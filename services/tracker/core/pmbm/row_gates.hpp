// Which objects have a measurement in their gates, in each row of a group: bits, for most have none.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boresight::tracking::pmbm {

class RowGates {
 public:
  RowGates(std::size_t most_rows, std::size_t most_objects, std::size_t most_measurements)
      : words_(word_of(most_objects + 63)) {
    bits_.reserve(most_rows * most_measurements * words_);
  }

  /// No measurement is in a gate.
  void clear(std::size_t rows, std::size_t measurements) {
    measurements_ = measurements;
    bits_.assign(rows * measurements * words_, 0);
  }
  void add(std::size_t row, std::size_t object, std::size_t z) {
    bits_[first_word(row, z) + word_of(object)] |= bit(object);
  }
  [[nodiscard]] bool has(std::size_t row, std::size_t object, std::size_t z) const {
    return (bits_[first_word(row, z) + word_of(object)] & bit(object)) != 0;
  }
  /// The objects with the measurement in their gates, in their order.
  template <typename Visit>
  void for_objects(std::size_t row, std::size_t z, const Visit& visit) const {
    const std::size_t first = first_word(row, z);
    for (std::size_t w = 0; w < words_; ++w) {
      for (std::uint64_t left = bits_[first + w]; left != 0; left &= left - 1) {
        visit(64 * w + static_cast<std::size_t>(std::countr_zero(left)));
      }
    }
  }

 private:
  [[nodiscard]] static std::size_t word_of(std::size_t object) { return object / 64; }
  [[nodiscard]] static std::uint64_t bit(std::size_t object) { return std::uint64_t{1} << (object % 64); }
  [[nodiscard]] std::size_t first_word(std::size_t row, std::size_t z) const {
    return (row * measurements_ + z) * words_;
  }

  std::size_t words_;  // of the objects of a row
  std::size_t measurements_ = 0;
  std::vector<std::uint64_t> bits_;  // rows × measurements × words
};

}  // namespace boresight::tracking::pmbm
