// Feeds the decoded messages of a recording to an alignment run in the order that interpolation needs.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "services/boresight/align/run.hpp"
#include "services/ingest_gateway/core/sink.hpp"

namespace boresight::align {

/// A scan waits for an ego motion that is newer than the scan, at most half a second of the recording. Scans that the
/// gateway marks as repeated, frozen, stale or made of copies are rejected, as in the service.
class RecordingFeed : public ingest::Sink {
 public:
  /// `run` must outlive the feed.
  explicit RecordingFeed(Run& run);

  RadarScan* begin_scan() override;
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override;
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const ingest::MeasurementTime& time) override;
  void fault(Fault fault, std::string_view what, std::uint32_t radar_id) override;
  SourceStatistics& statistics(std::uint32_t radar_id) override;

  /// Hands over the scans that still wait.
  void finish();
  /// Number of messages that the gateway rejected, and of scans with doubtful integrity.
  [[nodiscard]] std::uint64_t rejected() const { return rejected_; }
  [[nodiscard]] std::uint64_t doubtful() const { return doubtful_; }
  [[nodiscard]] double newest_s() const { return newest_s_; }

 private:
  struct Waiting {
    double time_s;
    std::unique_ptr<RadarScan> scan;
  };
  void release(bool all);

  Run& run_;
  EgoMotion ego_{};
  std::unique_ptr<RadarScan> scan_;
  std::deque<Waiting> waiting_;
  std::vector<std::unique_ptr<RadarScan>> spare_;
  std::array<SourceStatistics, kMaxRadars + 1> statistics_{};
  double newest_s_, newest_ego_s_;
  std::uint64_t rejected_ = 0, doubtful_ = 0;
};

}  // namespace boresight::align
