// A hash table of fixed size with one-step clearing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boresight::tracking {

/// Mixes all bits (splitmix64, Steele et al. 2014).
[[nodiscard]] inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// Maps keys to indices by open addressing. A full table forgets nothing and takes nothing new.
class FixedTable {
 public:
  /// `size` is a power of two, at least twice the largest number of entries.
  explicit FixedTable(std::size_t size) : slots_(size) {}

  void clear() {
    used_ = 0;
    if (++generation_ != 0) return;
    // Once in 2^32 times, all slots are emptied: those of a former round must not come back.
    for (Slot& slot : slots_) slot = {};
    generation_ = 1;
  }
  /// The index stored for a key, or −1.
  [[nodiscard]] int find(std::uint64_t key) const {
    for (std::size_t i = place(key);; i = (i + 1) & (slots_.size() - 1)) {
      const Slot& slot = slots_[i];
      if (slot.generation != generation_) return -1;
      if (slot.key == key) return slot.index;
    }
  }
  /// False if the table is full.
  bool insert(std::uint64_t key, int index) {
    if (2 * (used_ + 1) > slots_.size()) return false;
    std::size_t i = place(key);
    while (slots_[i].generation == generation_) i = (i + 1) & (slots_.size() - 1);
    slots_[i] = {key, generation_, index};
    ++used_;
    return true;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t generation = 0;
    int index = -1;
  };
  [[nodiscard]] std::size_t place(std::uint64_t key) const {
    return static_cast<std::size_t>(mixed(key)) & (slots_.size() - 1);
  }

  std::vector<Slot> slots_;
  std::uint32_t generation_ = 1;
  std::size_t used_ = 0;
};

}  // namespace boresight::tracking
