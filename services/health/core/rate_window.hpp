// Number and rate of events in the last seconds, in fixed memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight::health {

/// Sums of counted events over a sliding window, in slots of a tenth of it.
class RateWindow {
 public:
  explicit RateWindow(double window_s = 2.0)
      : slot_ns_(std::max<std::int64_t>(1, static_cast<std::int64_t>(window_s * 1e9) / kSlots)) {}

  void add(std::int64_t now_ns, std::uint64_t count = 1) {
    advance(now_ns);
    if (first_slot_ < 0) {
      first_slot_ = slot_;
      first_ns_ = now_ns;
    }
    last_ns_ = now_ns;
    since_first_ += count;
    counts_[static_cast<std::size_t>(slot_ % kLength)] += count;
  }

  /// Events in the complete slots of the window that ends now.
  [[nodiscard]] std::uint64_t sum(std::int64_t now_ns) {
    advance(now_ns);
    std::uint64_t total = 0;
    for (std::int64_t slot = std::max<std::int64_t>(0, slot_ - kSlots); slot < slot_; ++slot) {
      total += counts_[static_cast<std::size_t>(slot % kLength)];
    }
    return total;
  }
  /// Events per second over the window. Before a whole window has passed: over the time since the first event, and 0
  /// before the second event.
  [[nodiscard]] double rate_hz(std::int64_t now_ns) {
    if (is_full(now_ns)) return static_cast<double>(sum(now_ns)) / (kSlots * static_cast<double>(slot_ns_) * 1e-9);
    if (since_first_ < 2 || last_ns_ <= first_ns_) return 0.0;
    return static_cast<double>(since_first_ - 1) / (static_cast<double>(last_ns_ - first_ns_) * 1e-9);
  }
  /// True when a whole window has passed since the first event.
  [[nodiscard]] bool is_full(std::int64_t now_ns) {
    advance(now_ns);
    return first_slot_ >= 0 && slot_ - first_slot_ > kSlots;
  }
  /// Time since the first event; 0 without one.
  [[nodiscard]] double age_s(std::int64_t now_ns) const {
    return first_slot_ < 0 ? 0.0 : static_cast<double>(now_ns - first_ns_) * 1e-9;
  }
  /// Forgets everything: the source starts again.
  void clear() {
    counts_ = {};
    first_slot_ = -1;
    since_first_ = 0;
  }

 private:
  static constexpr std::int64_t kSlots = 10;
  static constexpr std::int64_t kLength = kSlots + 1;  // the present, incomplete slot is one more

  void advance(std::int64_t now_ns) {
    const std::int64_t slot = std::max<std::int64_t>(0, now_ns / slot_ns_);
    for (std::int64_t s = std::max(slot_ + 1, slot - kLength + 1); s <= slot; ++s) {
      counts_[static_cast<std::size_t>(s % kLength)] = 0;
    }
    slot_ = std::max(slot_, slot);
  }

  std::int64_t slot_ns_;
  std::int64_t slot_ = 0;
  std::int64_t first_slot_ = -1;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint64_t since_first_ = 0;
  std::array<std::uint64_t, kLength> counts_{};
};

}  // namespace boresight::health
