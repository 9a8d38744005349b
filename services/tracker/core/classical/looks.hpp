// The latest looks at an object, a bit each: hit or miss. Rules "m of n" count them.
#pragma once

#include <bit>
#include <cstdint>

namespace boresight::tracking::classical {

class Looks {
 public:
  static constexpr int kMost = 32;

  void add(bool is_hit) {
    hits_ = hits_ << 1U | (is_hit ? 1U : 0U);
    number_ = number_ < kMost ? number_ + 1 : kMost;
  }
  [[nodiscard]] int number() const { return number_; }
  /// Hits among the latest `looks`, at most kMost.
  [[nodiscard]] int hits(int looks) const { return std::popcount(hits_ & mask(looks)); }
  /// Misses among the latest `looks`; looks before the first one are neither.
  [[nodiscard]] int misses(int looks) const { return (looks < number_ ? looks : number_) - hits(looks); }

 private:
  [[nodiscard]] static std::uint32_t mask(int looks) {
    return looks >= kMost ? ~std::uint32_t{0} : (std::uint32_t{1} << static_cast<unsigned>(looks)) - 1U;
  }
  std::uint32_t hits_ = 0;
  int number_ = 0;
};

}  // namespace boresight::tracking::classical
