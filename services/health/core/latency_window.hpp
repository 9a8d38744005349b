// Mean and maximum of latencies over the last seconds, from the figures of heartbeats, in fixed memory.
#pragma once

#include <algorithm>
#include <cstdint>

namespace boresight::health {

/// Covers the present part of a window and the whole window before. Times are CLOCK_MONOTONIC, ns.
class LatencyWindow {
 public:
  explicit LatencyWindow(double window_s) : window_ns_(static_cast<std::int64_t>(window_s * 1e9)) {}

  /// `count` outputs with this mean and maximum, in µs.
  void add(std::int64_t now_ns, std::uint32_t count, float mean_us, float max_us) {
    advance(now_ns);
    present_.count += count;
    present_.sum_us += static_cast<double>(count) * static_cast<double>(mean_us);
    present_.max_us = std::max(present_.max_us, max_us);
  }
  /// 0 without outputs.
  [[nodiscard]] float mean_us(std::int64_t now_ns) {
    advance(now_ns);
    const std::uint64_t count = present_.count + before_.count;
    return count == 0 ? 0.0F : static_cast<float>((present_.sum_us + before_.sum_us) / static_cast<double>(count));
  }
  [[nodiscard]] float max_us(std::int64_t now_ns) {
    advance(now_ns);
    return std::max(present_.max_us, before_.max_us);
  }

 private:
  struct Part {
    std::uint64_t count = 0;
    double sum_us = 0.0;
    float max_us = 0.0F;
  };

  void advance(std::int64_t now_ns) {
    const std::int64_t age_ns = now_ns - begin_ns_;
    if (age_ns < window_ns_) return;
    before_ = age_ns < 2 * window_ns_ ? present_ : Part{};
    present_ = {};
    begin_ns_ = now_ns;
  }

  std::int64_t window_ns_;
  std::int64_t begin_ns_ = 0;
  Part present_;
  Part before_;
};

}  // namespace boresight::health
