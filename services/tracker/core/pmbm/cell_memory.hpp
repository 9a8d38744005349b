// Likelihoods of the cells of one group that have been asked for: the search comes back to many of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"

namespace boresight::tracking::pmbm {

/// A direct-mapped cache: a new value replaces the one in its place.
class CellMemory {
 public:
  /// `size` is a power of two.
  explicit CellMemory(std::size_t size) : slots_(size) {}

  /// Forgets everything.
  void clear() { salt_ = mixed(salt_); }
  /// Of a source of detections. Keys of measurements are mixed(1), mixed(2), …: those of sources must not be.
  [[nodiscard]] static std::uint64_t source_key(std::uint64_t source) { return mixed(~source); }
  /// The value of a cell under a source of detections; computed if it is not known.
  template <typename Compute>
  double value(std::uint64_t cell, std::uint64_t source_key, const Compute& compute) {
    const std::uint64_t key = mixed(cell ^ source_key) ^ salt_;
    Slot& slot = slots_[static_cast<std::size_t>(key) & (slots_.size() - 1)];
    if (slot.key != key) slot = {key, compute()};
    return slot.value;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    double value = 0.0;
  };
  std::vector<Slot> slots_;
  std::uint64_t salt_ = 1;
};

}  // namespace boresight::tracking::pmbm
