// The hand-shake between an end-of-line station that tilts a plate and the radar's calibration (Burza 2025, §7), as a
// state machine: commands, scans and clock ticks go in with their time; state, instruction, progress and result come
// out.
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
  kIdle,         ///< nothing was asked for yet
  kPositioning,  ///< started: the station brings the plate to tilt `tilt_index`, then says `measure`
  kMeasuring,    ///< scans are collected
  kTiltDone,     ///< enough scans: the station says `next`, or `repeat_tilt`
  kFinished,     ///< the result is valid
  kFailed,       ///< the run is over without one: see `failure`
};

/// What the station is to do now.
enum class Instruction : std::uint8_t {
  kStart,       ///< `start` a run
  kMovePlate,   ///< bring the plate to `tilt_rad`, then `measure`
  kWait,        ///< keep the plate still
  kSendNext,    ///< `next` (after the last tilt: computes the result), or `repeat_tilt`
  kTakeResult,  ///< read the result; `repeat_run` or `start` to do it again
  kRepeatRun,   ///< the run failed: `repeat_run` or `start`
};

/// Why a command was not obeyed. A refused command changes nothing.
enum class Refusal : std::uint8_t {
  kNone,               ///< it was obeyed
  kWrongState,         ///< not the command's turn
  kTooFewTilts,        ///< fewer than the configured minimum
  kTooManyTilts,       ///< more than kMaxTilts
  kTiltOutOfRange,     ///< not finite, or beyond ±kLargestTilt_rad
  kTiltsNotMonotonic,  ///< tilts must rise or fall throughout
  kScansOutOfRange,    ///< K outside kMinScansPerTilt…kMaxScansPerTilt
  kWrongTilt,          ///< the plate is farther from the tilt asked for than tolerated
  kNoRun,              ///< `repeat_run` before any `start`
};
[[nodiscard]] std::string_view name_of(State state);
[[nodiscard]] std::string_view name_of(Instruction instruction);
[[nodiscard]] std::string_view name_of(Refusal refusal);

/// Which column of the scan tells how strong the plate is.
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
  double max_range_rate_mps = 0.3;         ///< the plate stands still, and so does the car
  Amplitude amplitude = Amplitude::kAny;
};

struct StationConfig {
  PlateWindow window;
  FitConfig fit;
  double positioning_timeout_s = 60.0;  ///< in kPositioning
  double measuring_timeout_s = 30.0;    ///< in kMeasuring
  double silence_timeout_s = 3.0;       ///< in kMeasuring without a scan that shows the plate
  double decision_timeout_s = 60.0;     ///< in kTiltDone
  double settle_s = 0.2;                ///< scans that come sooner after `measure` do not count
  double tilt_tolerance_rad = 0.00524;  ///< 0.3°: by which the reported tilt may miss the one asked for
};

/// What the station asks for.
struct RunPlan {
  std::size_t number_of_tilts = 0;
  std::array<double, kMaxTilts> tilts_rad{};  ///< rising or falling throughout; positive = toward the ground
  std::size_t scans_per_tilt = 30;            ///< K
};

struct Progress {
  State state = State::kIdle;
  Instruction instruction = Instruction::kStart;
  Failure failure = Failure::kNone;
  std::size_t tilt_index = 0;  ///< 0-based; of the tilt being positioned, measured or just done
  std::size_t number_of_tilts = 0;
  double tilt_rad = 0.0;            ///< asked for; once measured, as reported by the station
  std::size_t scans_collected = 0;  ///< at this tilt
  std::size_t scans_per_tilt = 0;
  std::size_t scans_without_plate = 0;  ///< at this tilt
  double seconds_left = 0.0;            ///< until the state times out; 0 in states that never do
};

/// The plate's detection in a scan.
struct PlateEcho {
  bool seen = false;
  double amplitude_db = 0.0;
  double azimuth_rad = 0.0;
};
/// The strongest detection in the window that stands still; invalid and non-finite ones are passed over. Not seen as
/// well where the radar does not measure the amplitude asked for.
[[nodiscard]] PlateEcho find_plate(const RadarScan& scan, const PlateWindow& window);

/// One radar's calibration. Times are nanoseconds of any clock that does not go back (arrival, not measurement, times:
/// commands and scans must be on one clock). Every call first lets time-outs happen, so the order of a tick and a
/// command at the same instant makes no difference. Never allocates.
class PlateStation {
 public:
  explicit PlateStation(const StationConfig& config);

  /// In kIdle, kFinished and kFailed. The earlier result is gone once obeyed.
  Refusal start(const RunPlan& plan, std::int64_t time_ns);
  /// In kPositioning: the plate stands still at `tilt_rad` (as the station measured it).
  Refusal measure(double tilt_rad, std::int64_t time_ns);
  /// In kTiltDone: goes on to the next tilt; after the last one computes the result (kFinished or kFailed).
  Refusal next(std::int64_t time_ns);
  /// In kMeasuring and kTiltDone: drops what was collected at this tilt, back to kPositioning of the same tilt.
  Refusal repeat_tilt(std::int64_t time_ns);
  /// In any state but kIdle: the same plan from its first tilt; drops everything collected.
  Refusal repeat_run(std::int64_t time_ns);
  /// In kPositioning, kMeasuring and kTiltDone: the run fails with kAborted.
  Refusal abort(std::int64_t time_ns);

  /// A scan of this radar. Scans that repeat an earlier one (by their integrity bits, or by a measurement time that
  /// does not advance) do not count.
  void add_scan(const RadarScan& scan, std::int64_t time_ns);
  /// Lets time pass; call at least a few times a second.
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
