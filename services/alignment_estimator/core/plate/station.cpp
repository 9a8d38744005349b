#include "services/alignment_estimator/core/plate/station.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::alignment::plate {

namespace {

double seconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

/// Whether the tilts increase or decrease throughout.
bool is_monotonic(std::span<const double> tilts) {
  const bool rises = tilts.size() > 1 && tilts[1] > tilts[0];
  for (std::size_t i = 1; i < tilts.size(); ++i) {
    if (rises ? !(tilts[i] > tilts[i - 1]) : !(tilts[i] < tilts[i - 1])) return false;
  }
  return true;
}

}  // namespace

std::string_view name_of(State state) {
  switch (state) {
    case State::kIdle:
      return "IDLE";
    case State::kPositioning:
      return "POSITIONING";
    case State::kMeasuring:
      return "MEASURING";
    case State::kTiltDone:
      return "TILT_DONE";
    case State::kFinished:
      return "FINISHED";
    case State::kFailed:
      return "FAILED";
  }
  return "?";
}

std::string_view name_of(Instruction instruction) {
  switch (instruction) {
    case Instruction::kStart:
      return "START";
    case Instruction::kMovePlate:
      return "MOVE_PLATE";
    case Instruction::kWait:
      return "WAIT";
    case Instruction::kSendNext:
      return "SEND_NEXT";
    case Instruction::kTakeResult:
      return "TAKE_RESULT";
    case Instruction::kRepeatRun:
      return "REPEAT_RUN";
  }
  return "?";
}

std::string_view name_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone:
      return "NONE";
    case Refusal::kWrongState:
      return "WRONG_STATE";
    case Refusal::kTooFewTilts:
      return "TOO_FEW_TILTS";
    case Refusal::kTooManyTilts:
      return "TOO_MANY_TILTS";
    case Refusal::kTiltOutOfRange:
      return "TILT_OUT_OF_RANGE";
    case Refusal::kTiltsNotMonotonic:
      return "TILTS_NOT_MONOTONIC";
    case Refusal::kScansOutOfRange:
      return "SCANS_OUT_OF_RANGE";
    case Refusal::kWrongTilt:
      return "WRONG_TILT";
    case Refusal::kNoRun:
      return "NO_RUN";
  }
  return "?";
}

PlateEcho find_plate(const RadarScan& scan, const PlateWindow& window) {
  PlateEcho best;
  const bool use_rcs =
      window.amplitude == Amplitude::kRcs || (window.amplitude == Amplitude::kAny && scan.has(scan_field::kRcs));
  if (!scan.has(use_rcs ? scan_field::kRcs : scan_field::kSnr)) return best;
  const DetectionColumn<float>& amplitudes = use_rcs ? scan.rcs_dbsm : scan.snr_db;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    if ((scan.detection_flags[i] & detection_flag::kUntrusted) != 0) continue;
    const double amplitude = amplitudes[i], azimuth = scan.azimuth_rad[i], range = scan.range_m[i];
    // This form also rejects values that are not numbers.
    const bool in_window = range >= window.range_min_m && range <= window.range_max_m &&
                           std::abs(azimuth) <= window.azimuth_half_width_rad &&
                           std::abs(static_cast<double>(scan.range_rate_mps[i])) <= window.max_range_rate_mps;
    if (!in_window || !std::isfinite(amplitude) || (best.seen && amplitude <= best.amplitude_db)) continue;
    best = {true, amplitude, azimuth};
  }
  return best;
}

PlateStation::PlateStation(const StationConfig& config) : config_(config) {}

void PlateStation::enter(State state, std::int64_t time_ns) {
  state_ = state;
  entered_ns_ = last_echo_ns_ = time_ns;
}

void PlateStation::fail(Failure failure, std::int64_t time_ns) {
  result_.failure = failure;
  enter(State::kFailed, time_ns);
}

double PlateStation::timeout_s() const {
  switch (state_) {
    case State::kPositioning:
      return config_.positioning_timeout_s;
    case State::kMeasuring:
      return config_.measuring_timeout_s;
    case State::kTiltDone:
      return config_.decision_timeout_s;
    case State::kIdle:
    case State::kFinished:
    case State::kFailed:
      break;
  }
  return 0.0;
}

Refusal PlateStation::check(const RunPlan& plan) const {
  if (plan.number_of_tilts > kMaxTilts) return Refusal::kTooManyTilts;
  if (plan.number_of_tilts < std::max(config_.fit.min_tilts, kFewestTilts)) return Refusal::kTooFewTilts;
  const std::span<const double> tilts{plan.tilts_rad.data(), plan.number_of_tilts};
  for (const double tilt : tilts) {
    if (!(std::abs(tilt) <= kLargestTilt_rad)) return Refusal::kTiltOutOfRange;
  }
  if (!is_monotonic(tilts)) return Refusal::kTiltsNotMonotonic;
  if (plan.scans_per_tilt < kMinScansPerTilt || plan.scans_per_tilt > kMaxScansPerTilt) {
    return Refusal::kScansOutOfRange;
  }
  return Refusal::kNone;
}

Refusal PlateStation::start(const RunPlan& plan, std::int64_t time_ns) {
  tick(time_ns);
  if (state_ == State::kPositioning || state_ == State::kMeasuring || state_ == State::kTiltDone) {
    return Refusal::kWrongState;
  }
  if (const Refusal refusal = check(plan); refusal != Refusal::kNone) return refusal;
  plan_ = plan;
  has_plan_ = true;
  return repeat_run(time_ns);
}

Refusal PlateStation::measure(double tilt_rad, std::int64_t time_ns) {
  tick(time_ns);
  if (state_ != State::kPositioning) return Refusal::kWrongState;
  if (!(std::abs(tilt_rad) <= kLargestTilt_rad)) return Refusal::kTiltOutOfRange;
  if (std::abs(tilt_rad - plan_.tilts_rad[tilt_index_]) > config_.tilt_tolerance_rad) return Refusal::kWrongTilt;
  // Requested tilts that are closer than the tolerance may come in the wrong order.
  if (tilt_index_ > 0) {
    const double step = tilt_rad - measurements_.tilts[tilt_index_ - 1].tilt_rad;
    const bool rises = plan_.tilts_rad[1] > plan_.tilts_rad[0];
    if (rises ? !(step > 0.0) : !(step < 0.0)) return Refusal::kTiltsNotMonotonic;
  }
  TiltMeasurement& tilt = measurements_.tilts[tilt_index_];
  tilt = {};
  tilt.tilt_rad = tilt_rad;
  scans_without_plate_ = 0;
  enter(State::kMeasuring, time_ns);
  return Refusal::kNone;
}

Refusal PlateStation::next(std::int64_t time_ns) {
  tick(time_ns);
  if (state_ != State::kTiltDone) return Refusal::kWrongState;
  if (tilt_index_ + 1 < plan_.number_of_tilts) {
    ++tilt_index_;
    enter(State::kPositioning, time_ns);
    return Refusal::kNone;
  }
  measurements_.number_of_tilts = plan_.number_of_tilts;
  result_ = evaluate(measurements_, config_.fit);
  enter(result_.ok() ? State::kFinished : State::kFailed, time_ns);
  return Refusal::kNone;
}

Refusal PlateStation::repeat_tilt(std::int64_t time_ns) {
  tick(time_ns);
  if (state_ != State::kMeasuring && state_ != State::kTiltDone) return Refusal::kWrongState;
  enter(State::kPositioning, time_ns);
  return Refusal::kNone;
}

Refusal PlateStation::repeat_run(std::int64_t time_ns) {
  tick(time_ns);
  if (!has_plan_) return Refusal::kNoRun;
  measurements_.number_of_tilts = 0;
  result_ = {};
  tilt_index_ = 0;
  scans_without_plate_ = 0;
  enter(State::kPositioning, time_ns);
  return Refusal::kNone;
}

Refusal PlateStation::abort(std::int64_t time_ns) {
  tick(time_ns);
  if (timeout_s() == 0.0) return Refusal::kWrongState;
  fail(Failure::kAborted, time_ns);
  return Refusal::kNone;
}

void PlateStation::add_scan(const RadarScan& scan, std::int64_t time_ns) {
  tick(time_ns);
  constexpr std::uint16_t kNotNew = scan_integrity::kRepeated | scan_integrity::kFrozen | scan_integrity::kStale;
  const std::int64_t measured_ns = scan.header.measurement_time_ns;
  const bool is_new = measured_ns > last_measurement_ns_ && (scan.integrity & kNotNew) == 0;
  last_measurement_ns_ = measured_ns;
  if (state_ != State::kMeasuring || !is_new || seconds(time_ns - entered_ns_) < config_.settle_s) return;
  const PlateEcho echo = find_plate(scan, config_.window);
  if (!echo.seen) {
    ++scans_without_plate_;
    return;
  }
  last_echo_ns_ = time_ns;
  TiltMeasurement& tilt = measurements_.tilts[tilt_index_];
  if (tilt.add(echo.amplitude_db, echo.azimuth_rad) && tilt.scans == plan_.scans_per_tilt) {
    enter(State::kTiltDone, time_ns);
  }
}

void PlateStation::tick(std::int64_t time_ns) {
  // If the clock went back, the time of the state restarts; otherwise the state could last forever.
  entered_ns_ = std::min(entered_ns_, time_ns);
  last_echo_ns_ = std::min(last_echo_ns_, time_ns);
  const double limit_s = timeout_s();
  if (limit_s == 0.0) return;
  if (state_ == State::kMeasuring && seconds(time_ns - last_echo_ns_) > config_.silence_timeout_s) {
    fail(Failure::kNoPlateSeen, time_ns);
  } else if (seconds(time_ns - entered_ns_) > limit_s) {
    fail(state_ == State::kPositioning ? Failure::kPositioningTimeout
         : state_ == State::kMeasuring ? Failure::kMeasuringTimeout
                                       : Failure::kDecisionTimeout,
         time_ns);
  }
}

Progress PlateStation::progress(std::int64_t time_ns) const {
  Progress progress;
  progress.state = state_;
  progress.failure = state_ == State::kFailed ? result_.failure : Failure::kNone;
  switch (state_) {
    case State::kIdle:
      progress.instruction = Instruction::kStart;
      break;
    case State::kPositioning:
      progress.instruction = Instruction::kMovePlate;
      break;
    case State::kMeasuring:
      progress.instruction = Instruction::kWait;
      break;
    case State::kTiltDone:
      progress.instruction = Instruction::kSendNext;
      break;
    case State::kFinished:
      progress.instruction = Instruction::kTakeResult;
      break;
    case State::kFailed:
      progress.instruction = Instruction::kRepeatRun;
      break;
  }
  if (!has_plan_) return progress;
  const bool was_measured = state_ == State::kMeasuring || state_ == State::kTiltDone || state_ == State::kFinished;
  const TiltMeasurement& tilt = measurements_.tilts[tilt_index_];
  progress.tilt_index = tilt_index_;
  progress.number_of_tilts = plan_.number_of_tilts;
  progress.tilt_rad = was_measured ? tilt.tilt_rad : plan_.tilts_rad[tilt_index_];
  progress.scans_collected = was_measured ? tilt.scans : 0;
  progress.scans_per_tilt = plan_.scans_per_tilt;
  progress.scans_without_plate = scans_without_plate_;
  if (timeout_s() > 0.0) progress.seconds_left = std::max(0.0, timeout_s() - seconds(time_ns - entered_ns_));
  return progress;
}

}  // namespace boresight::alignment::plate
