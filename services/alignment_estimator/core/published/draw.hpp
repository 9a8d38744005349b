// Random draws that are the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

namespace boresight::alignment::published {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// 0 ≤ draw < 1.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// 0 ≤ draw < count; 0 if count is 0. The modulo bias is 2^-50 here.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(next() % count); }
  /// Moves `wanted` entries, drawn without replacement, to the front; all of them if there are no more.
  template <class Column>
  void to_front(Column& entries, std::size_t count, std::size_t wanted) {
    for (std::size_t i = 0; i < wanted && i < count; ++i) std::swap(entries[i], entries[i + below(count - i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace boresight::alignment::published
