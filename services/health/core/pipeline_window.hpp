// What happened to the scans of the last fraction of a second, in fixed memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "services/common/estimation/latency_histogram.hpp"

namespace boresight::health {

/// Sums over a time.
struct PipelineCounts {
  std::uint32_t delivered = 0;    ///< track lists, by the heartbeats of the tracker
  std::uint32_t lost = 0;         ///< scans lost or dropped between the stages, by heartbeats
  std::uint32_t budget_hits = 0;  ///< scans at a work budget, by heartbeats
  std::uint32_t late = 0;         ///< received track lists beyond the latency budget
  float queueing_max_us = 0.0F;   ///< longest time that a scan waited for a stage, by heartbeats
  LatencyHistogram latencies;     ///< of the received track lists, from the arrival of the scan

  void merge(const PipelineCounts& other) {
    delivered += other.delivered;
    lost += other.lost;
    budget_hits += other.budget_hits;
    late += other.late;
    queueing_max_us = std::max(queueing_max_us, other.queueing_max_us);
    latencies.merge(other.latencies);
  }
};

/// A sliding window in slots of an eighth of it. Times are CLOCK_MONOTONIC, ns.
class PipelineWindow {
 public:
  explicit PipelineWindow(double window_s)
      : slot_ns_(std::max<std::int64_t>(1, static_cast<std::int64_t>(window_s * 1e9) / kSlots)) {}

  /// The counts of the present slot, to be added to.
  [[nodiscard]] PipelineCounts& at(std::int64_t now_ns) {
    advance(now_ns);
    return slots_[static_cast<std::size_t>(slot_ % kSlots)];
  }
  /// Sums from the present slot back over the window: what has just happened counts at once.
  [[nodiscard]] PipelineCounts sum(std::int64_t now_ns) {
    advance(now_ns);
    PipelineCounts total;
    for (const PipelineCounts& slot : slots_) total.merge(slot);
    return total;
  }

 private:
  static constexpr std::int64_t kSlots = 8;

  void advance(std::int64_t now_ns) {
    const std::int64_t slot = std::max<std::int64_t>(0, now_ns / slot_ns_);
    for (std::int64_t s = std::max(slot_ + 1, slot - kSlots + 1); s <= slot; ++s) {
      slots_[static_cast<std::size_t>(s % kSlots)] = {};
    }
    slot_ = std::max(slot_, slot);
  }

  std::int64_t slot_ns_;
  std::int64_t slot_ = 0;
  std::array<PipelineCounts, kSlots> slots_{};
};

}  // namespace boresight::health
