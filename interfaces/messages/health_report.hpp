// The health service's judgement of every sensor and every service.
#pragma once

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/header.hpp"

namespace boresight {

/// Pair of qualifiers as in OSI (Open Simulation Interface): the effect on users of the data …
enum class DataQualifier : std::uint8_t { kAvailable = 0, kAvailableReduced = 1, kNotAvailable = 2 };
/// … and the reason.
enum class ExtendedQualifier : std::uint8_t {
  kNormal = 0,
  kMisaligned = 1,
  kNoData = 2,       ///< no data within the deadline
  kRateReduced = 3,  ///< data arrive, but too rarely
  kInvalidData = 4,  ///< too large a share is rejected or suspect, or the sensor reports a defect
  kBlocked = 5,
  kBeginningBlockage = 6,
  kExternalDisturbance = 7,
  kInitialising = 8,  ///< not tested yet: no data so far, or the mounting was never verified
  kWrongInput = 9,    ///< an input contradicts the vehicle file: SensorHealth::finding. Not a misalignment
  kDelayed = 10,      ///< scans arrive later after their measurement than the latency budget allows
};

/// What the health service tests for one radar: bits of SensorHealth::failed_events and untested_events. Each is an
/// event with a trouble code in the fault memory. The worst effect comes first; among equal ones, what a workshop must
/// repair.
enum class RadarEvent : std::uint8_t {
  kDefective = 0,
  kBlocked = 1,  ///< by the sensor's word
  kBlind = 2,    ///< by its detections: almost none, or none beyond a short distance
  kNoData = 3,
  kFrozen = 4,  ///< the same data again and again
  kEgoContradiction = 5,
  kYawBeyondLimit = 6,
  kPitchBeyondLimit = 7,
  kRollBeyondLimit = 8,
  kWrongInput = 9,
  kYawMisaligned = 10,
  kPitchMisaligned = 11,
  kRollMisaligned = 12,
  kPartlyBlocked = 13,  ///< by the sensor's word
  kReducedSight = 14,   ///< by its detections: fewer, or nearer, than it is used to
  kDisturbed = 15,      ///< interference
  kRejectedData = 16,
  kSuspectData = 17,
  kRateReduced = 18,
  kRateTooHigh = 19,
  kDelayed = 20,
  kSupply = 21,  // from here on without effect on the verdict
  kTemperature = 22,
  kUnsynchronised = 23,
  kWithoutEgoMotion = 24,
};
inline constexpr std::size_t kNumberOfRadarEvents = 25;

[[nodiscard]] constexpr std::uint32_t bit_of(RadarEvent event) {
  return 1u << static_cast<unsigned>(event);
}

/// What the error of an axis does to the use of the data.
enum class AxisEffect : std::uint8_t {
  kUnknown = 0,       ///< not determined
  kCompensated = 1,   ///< within the tolerance; the corrector removes it
  kReduced = 2,       ///< beyond the tolerance
  kNotAvailable = 3,  ///< beyond the limit of use
};

/// Misalignment of one axis against its tolerance and its limit of use.
struct AxisHealth {
  float error_rad;  ///< actual − nominal mounting
  float std_rad;
  float tolerance_rad;
  float limit_rad;
  float beyond_tolerance_probability;  ///< of |error| > tolerance, for an error of Gaussian distribution
  float beyond_limit_probability;
  std::uint8_t observable;        ///< 1 if the data determine this axis
  std::uint8_t beyond_tolerance;  ///< 1 if exceeded with the configured confidence, debounced
  /// 1: the values are about the vehicle's axis, because that error is beyond its tolerance or the sensor's axis is
  /// not observable; 0: about the sensor's own axis.
  std::uint8_t about_vehicle_axis;
  AxisEffect effect;
};
static_assert(sizeof(AxisHealth) == 28);

struct SensorHealth {
  std::uint32_t radar_id;  ///< 0: unused entry
  DataQualifier data_qualifier;
  ExtendedQualifier extended_qualifier;
  AlignmentReason reason;    ///< why the estimate is not converged; kNone if it is, or without one
  AlignmentFinding finding;  ///< wrong input that the estimator found, with its value and radar as in AlignmentEstimate
  float finding_value;
  std::uint32_t finding_radar;
  float rate_hz;
  float expected_rate_hz;
  float last_seen_s;  ///< since the last scan; negative if there was none
  float detections_per_scan;
  AxisHealth yaw;
  AxisHealth pitch;
  AxisHealth roll;
  float speed_scale;  ///< k_v as the radar sees it: AlignmentEstimate
  float speed_scale_std;
  AlignmentValue range_rate_scale;  ///< AlignmentNuisance
  AlignmentDrift drift;
  /// Consequences of the misalignment (Burza 2025, §6), for detections that the corrector does not correct. Lateral
  /// displacement of a detection at the reference range.
  float lateral_displacement_m;
  float reference_range_m;
  float lost_coverage_ratio;    ///< share of the region of interest that the turned field of view no longer covers
  float range_loss_ratio;       ///< of the range at which a target in the region's middle is detected; negative: gained
  float velocity_error_mps;     ///< error of a stationary object's velocity at the present speed; NaN: speed unknown
  std::uint32_t conditions;     ///< source_condition bits: the sensor's latest self-diagnosis
  std::uint32_t failed_events;  ///< RadarEvent bits: tests whose last known result is a failure
  std::uint32_t untested_events;  ///< RadarEvent bits: tests without a result that still counts
  std::uint32_t step_changes;     ///< sudden changes of the mounting since the estimator's start
  std::uint64_t scans;
  std::uint64_t lost_scans;     ///< published by the gateway, not received by the health service
  std::uint64_t missed_scans;   ///< sent according to the sensor's counter, but not received completely
  std::uint64_t suspect_scans;  ///< published by the gateway with an integrity fault
  // End-to-end protection of the radar's messages, if it has one:
  std::uint64_t e2e_lost;      ///< messages missing by the counter
  std::uint64_t e2e_repeated;  ///< messages with the previous counter, dropped
  std::uint64_t e2e_wrong;     ///< messages with a wrong CRC, length, Data ID or sequence, dropped
};
static_assert(sizeof(SensorHealth) == 256);

enum class ServiceCondition : std::uint8_t {
  kUnknown = 0,  ///< no heartbeat yet
  kAlive = 1,
  kDegraded = 2,   ///< alive, but misses deadlines, loses or drops input, or reports to be degraded
  kSilent = 3,     ///< heartbeat deadline missed
  kRestarted = 4,  ///< alive again after a restart within the last supervision window
};

struct ServiceHealth {
  std::uint32_t service;  ///< index in the catalogue
  ServiceCondition condition;
  std::uint8_t deadline_missed;  ///< 1 if its output topic is late although its input is not
  std::array<std::uint8_t, 2> reserved;
  float last_heartbeat_s;  ///< negative if there was none
  float output_rate_hz;
  float processing_max_us;
  /// From the arrival of a scan at the gateway to the output of this stage, over the last supervision window; 0 without
  /// outputs, and of services that are no stage.
  float latency_mean_us;
  float latency_max_us;
  std::uint32_t restarts;
  std::uint64_t lost_inputs;     ///< overflows of its queues
  std::uint64_t dropped_inputs;  ///< scans that waited until a newer one of their radar arrived
  std::uint64_t rejected_inputs;
  std::uint64_t heap_allocations;
};
static_assert(sizeof(ServiceHealth) == 64);

inline constexpr std::size_t kMaxServices = 16;

/// What the health service tests for the pipeline as a whole: bits of PipelineHealth::failed_events.
enum class PipelineEvent : std::uint8_t {
  kLosing = 0,      ///< scans are lost or dropped between the stages
  kQueueing = 1,    ///< scans wait too long for a stage
  kWorkBudget = 2,  ///< a stage ends its work on a scan before it is complete, to be in time
  kLate = 3,        ///< from arrival to track list longer than the latency budget
  kSilent = 4,      ///< no track list although scans arrive
};
inline constexpr std::size_t kNumberOfPipelineEvents = 5;

/// The way of the scans from arrival to track list, over the last supervision window.
struct PipelineHealth {
  DataQualifier data_qualifier;
  std::array<std::uint8_t, 3> reserved;
  std::uint32_t failed_events;  ///< PipelineEvent bits
  std::uint32_t lost_scans;     ///< lost or dropped between the stages
  std::uint32_t budget_hits;    ///< scans that met a work budget
  float queueing_max_ms;        ///< longest time that a scan waited for a stage
  float latency_p99_ms;         ///< from arrival to track list
};
static_assert(sizeof(PipelineHealth) == 24);

struct HealthReport {
  static constexpr std::uint32_t kVersion = 5;

  MessageHeader header;
  DataQualifier overall;
  std::array<std::uint8_t, 3> reserved;
  std::uint32_t number_of_sensors;
  std::uint32_t number_of_services;
  float latency_p50_ms;  ///< reception to track list, over the last supervision window
  float latency_max_ms;
  std::uint32_t stored_events;  ///< events in the fault memory that are confirmed or pending
  PipelineHealth pipeline;
  AlignmentVehicleChange load_change;  ///< of the vehicle: the latest that an estimate reported
  AlignmentVehicleChange speed_change;
  std::array<SensorHealth, kMaxRadars> sensors;
  std::array<ServiceHealth, kMaxServices> services;
};

static_assert(kIsPlainMessage<HealthReport>);
static_assert(sizeof(HealthReport) == 104 + 24 + 24 + 32 + kMaxRadars * 256 + kMaxServices * 64);

}  // namespace boresight
