// What the gateway decodes of a recording, fed to an alignment run in the order that interpolation needs.
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

/// Scans wait until an ego motion after their own time has come, half a second of the recording at most. Scans that the
/// gateway marks as repeated, frozen, stale or made of copies are left out, as the service does not believe them.
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

  /// Hands over what still waits.
  void finish();
  /// Messages that the gateway rejected, and scans of doubtful integrity.
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
