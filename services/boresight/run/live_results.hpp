// Messages of the running services as the results of the chain, for one who only listens.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "interfaces/messages/ego_motion.hpp"
#include "services/boresight/run/counts.hpp"
#include "services/boresight/run/results.hpp"

namespace boresight::run {

/// Pure but for its own memory. A scan is a result when its radar_scan, classified_scan and track_list have arrived, in
/// any order. They belong together by radar and time of measurement: each service numbers its own messages. Times are
/// those of the messages.
class LiveResults {
 public:
  /// Scans of a radar that may be incomplete at the same time: half a second at 20 Hz, longer than the queues before
  /// the tracker hold a scan. A capacity.
  static constexpr std::size_t kPending = 10;

  /// `start_ns` is the first measurement if it is known, else the first one that arrives.
  explicit LiveResults(Listeners listeners, std::optional<std::int64_t> start_ns = std::nullopt)
      : listeners_(std::move(listeners)), start_ns_(start_ns) {}

  void observe(const EgoMotion& ego);
  void observe(const RadarScan& scan);
  void observe(const ClassifiedScan& scan);
  void observe(const TrackList& tracks);
  /// Estimates of before the first measurement are not results.
  void observe(const AlignmentEstimate& estimate);
  /// A result once a second, and when a verdict changes.
  void observe(const HealthReport& report);
  /// Passes on the last verdicts, and counts scans that are still incomplete.
  void finish();

  [[nodiscard]] const Counts& counts() const { return counts_; }
  /// Scans of which a message did not arrive, by radar id.
  [[nodiscard]] const std::array<std::uint64_t, kMaxRadars + 1>& incomplete_scans() const { return incomplete_; }
  /// Losses before the bus as health reports them, by radar id.
  [[nodiscard]] const SensorHealth* health_of(std::uint32_t radar) const;
  /// 0 before the first measurement.
  [[nodiscard]] std::int64_t start_ns() const { return start_ns_.value_or(0); }
  [[nodiscard]] std::int64_t length_ns() const {
    return start_ns_ ? std::max<std::int64_t>(0, latest_ns_ - *start_ns_) : 0;
  }

 private:
  struct Pending {
    std::int64_t time_ns = 0;
    bool has_scan = false, has_classified = false, has_tracks = false;
    std::unique_ptr<RadarScan> scan;
    std::unique_ptr<ClassifiedScan> classified;
    std::unique_ptr<TrackList> tracks;
    [[nodiscard]] bool is_complete() const { return has_scan && has_classified && has_tracks; }
    [[nodiscard]] bool is_partial() const { return !is_complete() && (has_scan || has_classified || has_tracks); }
  };
  void note_measurement(std::int64_t time_ns);
  /// The place of a message; null if it comes too late for its scan.
  [[nodiscard]] Pending* place_of(const MessageHeader& header);
  template <typename Message>
  void add(const Message& message, std::unique_ptr<Message> Pending::*part, bool Pending::*has_part);

  Listeners listeners_;
  std::optional<std::int64_t> start_ns_;
  std::int64_t latest_ns_ = 0;
  std::map<std::uint32_t, std::array<Pending, kPending>> pending_;
  std::array<std::uint64_t, kMaxRadars + 1> incomplete_{};
  Counts counts_;
  HealthResult verdicts_;  // the latest, and whether and when such were passed on
  bool has_verdicts_ = false, is_reported_ = false;
  std::int64_t reported_ns_ = 0;
};

}  // namespace boresight::run
