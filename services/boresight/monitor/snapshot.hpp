// State of the running system at one moment as the monitor knows it: shown on the terminal, recorded, reported.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/names.hpp"
#include "interfaces/messages/service_status.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/boresight/monitor/damaged_lines.hpp"
#include "services/common/estimation/latency_histogram.hpp"

namespace boresight::monitor {

/// Keys of RadarSnapshot::beyond_tolerance.
inline constexpr std::array<const char*, 3> kBeyondKeys = {"yaw_beyond_tolerance", "pitch_beyond_tolerance",
                                                           "roll_beyond_tolerance"};

struct AngleEstimate {
  double value_rad = 0.0;
  double std_rad = 0.0;
  bool observable = false;
};

/// Details of the alignment estimate and of its convergence.
struct AlignmentDetails {
  // About the vehicle's axes; RadarSnapshot's yaw, pitch and roll are about the radar's own axes.
  AngleEstimate yaw, pitch, roll;
  AngleEstimate yaw_rate_bias;  ///< rad/s
  AngleEstimate slip;           ///< rad per m/s²
  std::uint32_t step_changes = 0;
  std::string reason = "none";                                ///< keys of alignment_words
  std::string finding = "none";                               //
  double range_rate_scale = 0.0, range_rate_scale_std = 0.0;  ///< measured / true range rate − 1; 0 ± 0: not estimated
  std::string drift;                                          ///< a drift that is reported, as a sentence; empty: none
  double yaw_seconds_to_95_percent = std::numeric_limits<double>::quiet_NaN();
  double pitch_seconds_to_95_percent = std::numeric_limits<double>::quiet_NaN();
  double yaw_drift_radpmin = std::numeric_limits<double>::quiet_NaN();
  double residual_rmse_mps = std::numeric_limits<double>::quiet_NaN();
  double nees = std::numeric_limits<double>::quiet_NaN();
};

/// Labels of the detections in all scans of the ghost filter that the monitor received.
struct LabelCounts {
  std::array<std::uint64_t, kNumberOfProvenances> classified{};  ///< by Provenance
  std::uint64_t rejected = 0;                                    ///< by the corrector before; not classified
  std::uint64_t scans = 0;
  std::uint64_t scans_without_tracks = 0;  ///< classified without tracks, or with outdated ones

  [[nodiscard]] std::uint64_t of(Provenance label) const { return classified[static_cast<std::size_t>(label)]; }
  /// Classified and rejected ones.
  [[nodiscard]] std::uint64_t detections() const {
    std::uint64_t sum = rejected;
    for (const std::uint64_t count : classified) sum += count;
    return sum;
  }
};

struct RadarSnapshot {
  std::uint32_t id = 0;
  std::string name;
  std::uint64_t scans = 0;       ///< received by the monitor
  std::uint64_t lost = 0;        ///< by gaps in the sequence numbers
  double rate_hz = 0.0;          ///< over the last two seconds
  std::uint32_t detections = 0;  ///< of the latest scan, as are the next two
  std::uint32_t moving = 0;
  std::uint32_t ghosts = 0;
  AlignmentState state = AlignmentState::kNoData;
  AngleEstimate yaw;
  AngleEstimate pitch;
  AngleEstimate roll;
  double speed_scale = 1.0;
  double speed_scale_std = 0.0;
  AlignmentDetails details;
  DataQualifier data_qualifier = DataQualifier::kNotAvailable;
  ExtendedQualifier extended_qualifier = ExtendedQualifier::kInitialising;
  /// Of the health report: the wrong input, axes beyond their tolerance, a drift, or why the estimate is not converged.
  std::string explanation;
  std::array<bool, 3> beyond_tolerance{};  ///< yaw, pitch, roll
  double yaw_tolerance_rad = 0.0;
  std::uint32_t conditions = 0;  ///< source_condition bits of the sensor; this and the next two from health reports
  std::uint64_t missed = 0;      ///< sent by the sensor, lost or incomplete at the gateway
  std::uint64_t suspect = 0;     ///< of doubtful integrity
  LabelCounts labels;
};

struct TrackSnapshot {
  std::uint32_t id = 0;
  bool confirmed = false;
  MovementState movement = MovementState::kUnknown;
  ObjectClass object_class = ObjectClass::kUnknown;
  double existence = 0.0;           ///< probability
  double mirror_probability = 0.0;  ///< that it is a mirror image of another object
  double x_m = 0.0;
  double y_m = 0.0;
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double age_s = 0.0;
};

struct ServiceSnapshot {
  catalogue::Service service = catalogue::Service::kMonitor;
  ServiceCondition condition = ServiceCondition::kUnknown;  ///< reported by the health service
  std::uint32_t restarts = 0;
  std::uint64_t inputs = 0;
  std::uint64_t outputs = 0;
  std::uint64_t heap_allocations = 0;
  double processing_max_us = 0.0;
  /// From the arrival of a scan to the output of this service: of the last seconds, by the health service; and the
  /// largest since the start of the monitor. 0: no stage of a scan, or no output.
  double latency_mean_us = 0.0;
  double latency_max_us = 0.0;
  std::array<std::uint64_t, kNumberOfFaults> faults{};

  [[nodiscard]] std::uint64_t count(Fault fault) const { return faults[static_cast<std::size_t>(fault)]; }
};

/// The way of the scans from arrival to track list, by the health service.
struct PipelineSnapshot {
  DataQualifier data_qualifier = DataQualifier::kNotAvailable;
  std::uint32_t failed_events = 0;  ///< PipelineEvent bits
  std::uint32_t lost_scans = 0;     ///< between the stages, over the last supervision window as are the next three
  std::uint32_t budget_hits = 0;    ///< scans that met a work budget
  double queueing_max_ms = 0.0;     ///< longest time that a scan waited for a stage
  double latency_p99_ms = 0.0;      ///< from arrival to track list
};

/// A test of the pipeline whose last known result is a failure.
struct FailedEvent {
  std::string code;  ///< trouble code
  std::string_view meaning;
};
[[nodiscard]] std::vector<FailedEvent> failed_events_of(const PipelineSnapshot& pipeline);

/// Time spent in each stage (from its input to its output), and last the total: reception to track list.
inline constexpr std::size_t kNumberOfLatencies = kNumberOfStages + 1;
inline constexpr std::array<std::string_view, kNumberOfLatencies> kLatencyNames = {"ingest", "corrector",
                                                                                   "ghost filter", "tracker", "total"};

struct Snapshot {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC
  double ego_speed_mps = 0.0;
  double ego_yaw_rate_radps = 0.0;
  std::uint64_t track_lists = 0;
  DataQualifier overall = DataQualifier::kNotAvailable;  ///< by the health service; without it nothing is available
  PipelineSnapshot pipeline;
  std::string load_change, speed_change;  ///< the latest of the vehicle, as sentences; empty: none was reported
  std::vector<RadarSnapshot> radars;      ///< in the order of the vehicle file
  std::vector<TrackSnapshot> tracks;      ///< nearest first
  std::vector<ServiceSnapshot> services;  ///< in the order of the catalogue
  std::array<LatencyHistogram, kNumberOfLatencies> latencies;
};

/// One line of JSON with line feed: config/schema/run.md, monitor.jsonl.
[[nodiscard]] std::string to_json(const Snapshot& snapshot);
/// Reads such lines. A line with a field that is missing or not allowed is skipped and counted. Errors name the file
/// `name`.
[[nodiscard]] std::vector<Snapshot> read_snapshots(std::istream& input, const std::string& name, DamagedLines& damaged);

}  // namespace boresight::monitor
