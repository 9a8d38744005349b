// The dialogue between an end-of-line station that tilts a plate and the radar's calibration (Burza 2025, §7), as a
// state machine: commands, scans and clock ticks with their time in; state, instruction, progress and result out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "interfaces/messages/radar_scan.hpp"
#include "services/alignment_estimator/core/plate/fit.hpp"
#include "services/alignment_estimator/core/plate/measurement.hpp"

namespace boresight::alignment::plate {

enum class State : std::uint8_t {
  kIdle,         ///< no request yet
  kPositioning,  ///< started: the station moves the plate to tilt `tilt_index`, then sends `measure`
  kMeasuring,    ///< scans are collected
  kTiltDone,     ///< enough scans: the station sends `next` or `repeat_tilt`
  kFinished,     ///< the result is valid
  kFailed,       ///< the run ended without a result: see `failure`
};

/// The next action of the station.
enum class Instruction : std::uint8_t {
  kStart,       ///< `start` a run
  kMovePlate,   ///< move the plate to `tilt_rad`, then `measure`
  kWait,        ///< keep the plate still
  kSendNext,    ///< `next` (after the last tilt: computes the result), or `repeat_tilt`
  kTakeResult,  ///< read the result; `repeat_run` or `start` to do it again
  kRepeatRun,   ///< the run failed: `repeat_run` or `start`
};

/// Reason for refusing a command. A refused command changes nothing.
enum class Refusal : std::uint8_t {
  kNone,               ///< the command was executed
  kWrongState,         ///< the command is not permitted in this state
  kTooFewTilts,        ///< fewer than the configured minimum
  kTooManyTilts,       ///< more than kMaxTilts
  kTiltOutOfRange,     ///< not finite, or beyond ±kLargestTilt_rad
  kTiltsNotMonotonic,  ///< tilts must increase or decrease throughout
  kScansOutOfRange,    ///< K outside kMinScansPerTilt…kMaxScansPerTilt
  kWrongTilt,          ///< the plate differs from the requested tilt by more than the tolerance
  kNoRun,              ///< `repeat_run` before any `start`
};
[[nodiscard]] std::string_view name_of(State state);
[[nodiscard]] std::string_view name_of(Instruction instruction);
[[nodiscard]] std::string_view name_of(Refusal refusal);

/// The column of the scan with the amplitude of the plate.
enum class Amplitude : std::uint8_t {
  kAny,  ///< RCS where the radar measures it, else SNR
  kRcs,
  kSnr,
};

/// Where the plate may appear, in the sensor frame.
struct PlateWindow {
  double range_min_m = 1.0;
  double range_max_m = 10.0;
  double azimuth_half_width_rad = 0.1396;  ///< 8° about straight ahead
  double max_range_rate_mps = 0.3;         ///< plate and car are stationary
  Amplitude amplitude = Amplitude::kAny;
};

struct StationConfig {
  PlateWindow window;
  FitConfig fit;
  double positioning_timeout_s = 60.0;  ///< in kPositioning
  double measuring_timeout_s = 30.0;    ///< in kMeasuring
  double silence_timeout_s = 3.0;       ///< in kMeasuring without a scan that contains the plate
  double decision_timeout_s = 60.0;     ///< in kTiltDone
  double settle_s = 0.2;                ///< earlier scans after `measure` do not count
  double tilt_tolerance_rad = 0.00524;  ///< 0.3°: permitted difference between requested and reported tilt
};

/// The request of the station.
struct RunPlan {
  std::size_t number_of_tilts = 0;
  std::array<double, kMaxTilts> tilts_rad{};  ///< increasing or decreasing throughout; positive = toward the ground
  std::size_t scans_per_tilt = 30;            ///< K
};

struct Progress {
  State state = State::kIdle;
  Instruction instruction = Instruction::kStart;
  Failure failure = Failure::kNone;
  std::size_t tilt_index = 0;  ///< 0-based index of the current tilt
  std::size_t number_of_tilts = 0;
  double tilt_rad = 0.0;            ///< requested; after the measurement as reported by the station
  std::size_t scans_collected = 0;  ///< at this tilt
  std::size_t scans_per_tilt = 0;
  std::size_t scans_without_plate = 0;  ///< at this tilt
  double seconds_left = 0.0;            ///< until the state times out; 0 in states without a time-out
};

/// The plate's detection in a scan.
struct PlateEcho {
  bool seen = false;
  double amplitude_db = 0.0;
  double azimuth_rad = 0.0;
};
/// The strongest stationary detection in the window, without invalid and non-finite ones. Not seen if the radar does
/// not measure the requested amplitude.
[[nodiscard]] PlateEcho find_plate(const RadarScan& scan, const PlateWindow& window);

/// The calibration of one radar. Times are nanoseconds of a monotonic clock; commands and scans use the same clock, so
/// scans come with their arrival time. Every call first checks time-outs, so the order of a tick and a command at the
/// same instant makes no difference. Never allocates.
class PlateStation {
 public:
  explicit PlateStation(const StationConfig& config);

  /// In kIdle, kFinished and kFailed. An executed `start` deletes the earlier result.
  Refusal start(const RunPlan& plan, std::int64_t time_ns);
  /// In kPositioning: the plate is at rest at `tilt_rad`, as measured by the station.
  Refusal measure(double tilt_rad, std::int64_t time_ns);
  /// In kTiltDone: goes on to the next tilt; after the last one computes the result (kFinished or kFailed).
  Refusal next(std::int64_t time_ns);
  /// In kMeasuring and kTiltDone: deletes the scans of this tilt and returns to kPositioning of the same tilt.
  Refusal repeat_tilt(std::int64_t time_ns);
  /// In any state except kIdle: deletes all scans and begins the same plan at its first tilt.
  Refusal repeat_run(std::int64_t time_ns);
  /// In kPositioning, kMeasuring and kTiltDone: the run fails with kAborted.
  Refusal abort(std::int64_t time_ns);

  /// Adds a scan of this radar. Repeated scans do not count; integrity bits or a measurement time that does not advance
  /// mark them.
  void add_scan(const RadarScan& scan, std::int64_t time_ns);
  /// Checks time-outs; call at least a few times per second.
  void tick(std::int64_t time_ns);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] Progress progress(std::int64_t time_ns) const;
  /// Valid in kFinished; in kFailed after `next` it holds what could be computed and `failure`.
  [[nodiscard]] const PlateResult& result() const { return result_; }
  [[nodiscard]] const StationConfig& config() const { return config_; }
  [[nodiscard]] const RunPlan& plan() const { return plan_; }

 private:
  void enter(State state, std::int64_t time_ns);
  void fail(Failure failure, std::int64_t time_ns);
  /// Seconds after which the state times out; 0: never.
  [[nodiscard]] double timeout_s() const;
  [[nodiscard]] Refusal check(const RunPlan& plan) const;

  StationConfig config_;
  State state_ = State::kIdle;
  std::int64_t entered_ns_ = 0;  ///< when the state began
  std::int64_t last_echo_ns_ = 0;
  std::int64_t last_measurement_ns_ = 0;
  std::size_t tilt_index_ = 0;
  std::size_t scans_without_plate_ = 0;
  bool has_plan_ = false;
  RunPlan plan_;
  Measurements measurements_;
  PlateResult result_;
};

}  // namespace boresight::alignment::plate
