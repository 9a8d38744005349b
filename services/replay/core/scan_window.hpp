// Scans on their way through the pipeline, so that a replay sends no faster than the pipeline takes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>

namespace boresight::replay {

/// Identifies a scan in the messages of every stage. Their sequence numbers do not: each writer counts its own.
struct ScanId {
  std::uint32_t radar = 0;
  std::int64_t measurement_time_ns = 0;
  friend bool operator==(const ScanId&, const ScanId&) = default;
};

/// Of one radar.
struct ScanCounts {
  std::uint64_t published = 0;  ///< by the gateway
  std::uint64_t returned = 0;   ///< with a track list
  std::uint64_t missing =
      0;                    ///< without a track list, although a later scan of the radar has one, or after the timeout
  std::uint64_t waits = 0;  ///< times that the replay waited for a scan of this radar
};

/// Each stage handles the scans of a radar in their order, and may drop one that a later one supersedes. So a scan is
/// missing as soon as the track list of a later one of its radar comes. Scans of other radars may be reordered. Times
/// are monotonic.
class ScanWindow {
 public:
  /// `limit`: scans that may be in flight. `timeout_ns`: time without any track list after which the scans in flight
  /// are missing, and the pipeline counts as silent.
  ScanWindow(std::size_t limit, std::int64_t timeout_ns) : limit_(limit), timeout_ns_(timeout_ns) {}

  /// The gateway published the scan.
  void publish(const ScanId& scan, std::int64_t now_ns);
  /// The tracker published the scan's track list. The reader of two topics may take the list before the scan.
  void take_back(const ScanId& scan, std::int64_t now_ns);
  /// The time has come to `now_ns`.
  void expire(std::int64_t now_ns);
  /// The replay begins to wait for the oldest scan.
  void begin_wait();

  /// Whether the next frame has to wait. Never if the pipeline is silent.
  [[nodiscard]] bool is_full() const { return !silent_ && in_flight_.size() >= limit_; }
  [[nodiscard]] bool is_empty() const { return in_flight_.empty(); }
  [[nodiscard]] bool is_silent() const { return silent_; }
  /// Whether any track list came.
  [[nodiscard]] bool is_answered() const { return answered_; }
  [[nodiscard]] const std::map<std::uint32_t, ScanCounts>& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t missing() const;

 private:
  std::size_t limit_;
  std::int64_t timeout_ns_;
  std::deque<ScanId> in_flight_;  // oldest first
  std::deque<ScanId> early_;      // scans whose list was taken first; a few, the oldest are dropped
  std::int64_t waiting_since_ns_ = 0;
  bool silent_ = false;
  bool answered_ = false;
  std::map<std::uint32_t, ScanCounts> counts_;
};

}  // namespace boresight::replay
