// A recorded run of the tilting plate: the radar's scans, and a table of the time intervals of the tilts.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "services/alignment_estimator/core/plate/measurement.hpp"
#include "services/alignment_estimator/core/plate/station.hpp"
#include "services/boresight/input/csv_table.hpp"
#include "services/ingest_gateway/core/sink.hpp"

namespace boresight::calibrate {

/// An interval of the recording's clock with the plate at rest at this tilt.
struct TiltInterval {
  double tilt_rad;
  double begin_s;
  double end_s;
};

/// Columns tilt_deg (−20…20, positive = toward the ground), begin_s and end_s (the recording's stamps: UNIX time where
/// it was recorded live), a row for each tilt, in the order of time and without overlap. Rows that cannot be used are
/// reported to `problems` and skipped; throws input::TableError as CsvTable does.
[[nodiscard]] std::vector<TiltInterval> read_tilts(recording::ByteSource& source, input::Problems& problems);

/// Collects one radar's echoes of the plate. From each scan within an interval it takes the same echo as the station of
/// the service. Scans of doubtful integrity and scans beyond kMaxScansPerTilt at a tilt are not used.
class PlateFeed : public ingest::Sink {
 public:
  /// At most plate::kMaxTilts intervals.
  PlateFeed(std::uint32_t radar, std::vector<TiltInterval> intervals, const alignment::plate::PlateWindow& window);

  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override;
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const ingest::MeasurementTime&) override {}
  void fault(Fault fault, std::string_view what, std::uint32_t radar_id) override;
  SourceStatistics& statistics(std::uint32_t radar_id) override;

  [[nodiscard]] const alignment::plate::Measurements& measurements() const { return measurements_; }
  /// Number of the radar's scans in the recording, of those within intervals, and of those among them without the
  /// plate.
  [[nodiscard]] std::uint64_t scans() const { return scans_; }
  [[nodiscard]] std::uint64_t within() const { return within_; }
  [[nodiscard]] std::uint64_t without_plate() const { return without_plate_; }
  [[nodiscard]] std::uint64_t doubtful() const { return doubtful_; }
  /// Number of messages from the radar, or from an unknown sender, that the gateway rejected.
  [[nodiscard]] std::uint64_t rejected() const { return rejected_; }
  /// Measurement times of the radar's first and last scan, s.
  [[nodiscard]] double first_s() const { return first_s_; }
  [[nodiscard]] double last_s() const { return last_s_; }

 private:
  std::uint32_t radar_;
  std::vector<TiltInterval> intervals_;
  alignment::plate::PlateWindow window_;
  std::unique_ptr<RadarScan> scan_;
  EgoMotion ego_{};
  alignment::plate::Measurements measurements_;
  std::array<SourceStatistics, kMaxRadars + 1> statistics_{};
  std::uint64_t scans_ = 0, within_ = 0, without_plate_ = 0, doubtful_ = 0, rejected_ = 0;
  double first_s_ = 0.0, last_s_ = 0.0;
};

}  // namespace boresight::calibrate
