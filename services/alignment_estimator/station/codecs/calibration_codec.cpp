#include "services/alignment_estimator/station/codecs/calibration_codec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/common/someip/big_endian.hpp"

namespace boresight::alignment::station {

namespace service = wire::calibration_service;

namespace {

// The numbers on the wire are fixed; the enumerations of the state machine may grow but keep these values.
template <typename Wire, typename Own>
constexpr bool same(Wire wire, Own own) {
  return static_cast<unsigned>(wire) == static_cast<unsigned>(own);
}
static_assert(same(service::State::kIdle, plate::State::kIdle));
static_assert(same(service::State::kPositioning, plate::State::kPositioning));
static_assert(same(service::State::kMeasuring, plate::State::kMeasuring));
static_assert(same(service::State::kTiltDone, plate::State::kTiltDone));
static_assert(same(service::State::kFinished, plate::State::kFinished));
static_assert(same(service::State::kFailed, plate::State::kFailed));
static_assert(same(service::Instruction::kStart, plate::Instruction::kStart));
static_assert(same(service::Instruction::kMovePlate, plate::Instruction::kMovePlate));
static_assert(same(service::Instruction::kWait, plate::Instruction::kWait));
static_assert(same(service::Instruction::kSendNext, plate::Instruction::kSendNext));
static_assert(same(service::Instruction::kTakeResult, plate::Instruction::kTakeResult));
static_assert(same(service::Instruction::kRepeatRun, plate::Instruction::kRepeatRun));
static_assert(same(service::Failure::kNone, plate::Failure::kNone));
static_assert(same(service::Failure::kAborted, plate::Failure::kAborted));
static_assert(same(service::Failure::kPositioningTimeout, plate::Failure::kPositioningTimeout));
static_assert(same(service::Failure::kNoPlateSeen, plate::Failure::kNoPlateSeen));
static_assert(same(service::Failure::kMeasuringTimeout, plate::Failure::kMeasuringTimeout));
static_assert(same(service::Failure::kDecisionTimeout, plate::Failure::kDecisionTimeout));
static_assert(same(service::Failure::kTooFewTilts, plate::Failure::kTooFewTilts));
static_assert(same(service::Failure::kTooFewScans, plate::Failure::kTooFewScans));
static_assert(same(service::Failure::kTiltsNotMonotonic, plate::Failure::kTiltsNotMonotonic));
static_assert(same(service::Failure::kNotFinite, plate::Failure::kNotFinite));
static_assert(same(service::Failure::kNoMaximum, plate::Failure::kNoMaximum));
static_assert(same(service::Failure::kMaximumOutsideTilts, plate::Failure::kMaximumOutsideTilts));
static_assert(same(service::Failure::kAmplitudeTooLow, plate::Failure::kAmplitudeTooLow));
static_assert(same(service::Refusal::kNone, plate::Refusal::kNone));
static_assert(same(service::Refusal::kWrongState, plate::Refusal::kWrongState));
static_assert(same(service::Refusal::kTooFewTilts, plate::Refusal::kTooFewTilts));
static_assert(same(service::Refusal::kTooManyTilts, plate::Refusal::kTooManyTilts));
static_assert(same(service::Refusal::kTiltOutOfRange, plate::Refusal::kTiltOutOfRange));
static_assert(same(service::Refusal::kTiltsNotMonotonic, plate::Refusal::kTiltsNotMonotonic));
static_assert(same(service::Refusal::kScansOutOfRange, plate::Refusal::kScansOutOfRange));
static_assert(same(service::Refusal::kWrongTilt, plate::Refusal::kWrongTilt));
static_assert(same(service::Refusal::kNoRun, plate::Refusal::kNoRun));
static_assert(same(service::start::kMethodRobust, plate::FitMethod::kRobust));
static_assert(same(service::start::kMethodPublished, plate::FitMethod::kPublished));

bool has_layout(std::span<const std::uint8_t> payload, std::size_t bytes) {
  return payload.size() == bytes && read_u16(payload.data()) == service::kLayoutVersionValue;
}

double tilt_at(const std::uint8_t* p) {
  return static_cast<std::int16_t>(read_u16(p)) * service::kRadiansPerUnitOfTilt;
}

std::uint16_t tilt_code(double tilt_rad) {
  if (!std::isfinite(tilt_rad)) return 0;
  const double units = std::clamp(std::round(tilt_rad / service::kRadiansPerUnitOfTilt), -32767.0, 32767.0);
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(units));
}

template <typename Number>
std::uint16_t count_code(Number count) {
  return static_cast<std::uint16_t>(std::min<std::uint64_t>(count, 0xFFFF));
}

/// The wire has no infinite values: a value that could not be computed is NaN.
float number_code(double value) {
  const auto narrow = static_cast<float>(value);
  return std::isfinite(narrow) ? narrow : std::numeric_limits<float>::quiet_NaN();
}

template <typename Enum>
std::uint8_t code_of(Enum value) {
  return static_cast<std::uint8_t>(value);
}

}  // namespace

service::Refusal on_wire(plate::Refusal refusal) {
  return static_cast<service::Refusal>(refusal);
}

std::optional<StartRequest> read_start(std::span<const std::uint8_t> payload) {
  namespace layout = service::start;
  if (payload.size() < layout::kMinHeaderBytes) return std::nullopt;
  const std::uint8_t* const bytes = payload.data();
  const std::size_t header_bytes = read_u16(bytes + layout::kHeaderBytes);
  const std::size_t tilts = read_u16(bytes + layout::kNumberOfTilts);
  if (read_u16(bytes) != service::kLayoutVersionValue || header_bytes < layout::kMinHeaderBytes ||
      header_bytes % 4 != 0 || payload.size() != header_bytes + tilts * layout::kTiltBytes) {
    return std::nullopt;
  }
  StartRequest request;
  request.radar_id = read_u32(bytes + layout::kRadarId);
  request.plan.number_of_tilts = tilts;
  request.plan.scans_per_tilt = read_u16(bytes + layout::kScansPerTilt);
  for (std::size_t i = 0; i < std::min(tilts, request.plan.tilts_rad.size()); ++i) {
    request.plan.tilts_rad[i] = tilt_at(bytes + header_bytes + i * layout::kTiltBytes);
  }
  const std::uint8_t fields = bytes[layout::kFields];
  if ((fields & layout::field::kMethod) != 0) request.method = bytes[layout::kMethod];
  if ((fields & layout::field::kMinAmplitude) != 0) {
    request.min_amplitude_db = read_f32(bytes + layout::kMinAmplitude_db);
  }
  return request;
}

std::optional<MeasureRequest> read_measure(std::span<const std::uint8_t> payload) {
  namespace layout = service::measure;
  if (!has_layout(payload, layout::kBytes)) return std::nullopt;
  MeasureRequest request;
  request.tilt_index = read_u16(payload.data() + layout::kTiltIndex);
  const std::uint8_t* const tilt = payload.data() + layout::kTilt;
  if (static_cast<std::int16_t>(read_u16(tilt)) != layout::kAsAskedFor) request.tilt_rad = tilt_at(tilt);
  return request;
}

std::optional<std::size_t> read_tilt(std::span<const std::uint8_t> payload) {
  namespace layout = service::tilt;
  if (!has_layout(payload, layout::kBytes)) return std::nullopt;
  return read_u16(payload.data() + layout::kTiltIndex);
}

bool read_run(std::span<const std::uint8_t> payload) {
  return has_layout(payload, service::run::kBytes);
}

void write_state(const RunState& state, someip::ByteWriter& out) {
  const plate::Progress& progress = state.progress;
  const double left_ms = std::clamp(progress.seconds_left * 1e3, 0.0, 4294967295.0);
  out.u16(service::kLayoutVersionValue);
  out.u16(service::state::kBytes);
  out.u32(state.run);
  out.u8(code_of(progress.state));
  out.u8(code_of(progress.instruction));
  out.u8(code_of(progress.failure));
  out.u8(0);
  out.u32(state.radar_id);
  out.u16(count_code(progress.tilt_index));
  out.u16(count_code(progress.number_of_tilts));
  out.u16(tilt_code(progress.tilt_rad));
  out.u16(count_code(progress.scans_per_tilt));
  out.u16(count_code(progress.scans_collected));
  out.u16(count_code(progress.scans_without_plate));
  out.u32(static_cast<std::uint32_t>(left_ms));
  out.u16(state.client);
  out.u16(0);
}

void write_verdict(service::Refusal refusal, const RunState& state, someip::ByteWriter& out) {
  out.u8(refusal == service::Refusal::kNone ? 1 : 0);
  out.u8(code_of(refusal));
  out.u16(0);
  write_state(state, out);
}

void write_result(const RunState& state, const plate::PlateResult& result, bool taken_over, someip::ByteWriter& out) {
  const std::size_t tilts = std::min(result.number_of_tilts, result.tilts.size());
  out.u16(service::kLayoutVersionValue);
  out.u16(service::result::kBytes);
  out.u32(state.run);
  out.u32(state.radar_id);
  out.u8(code_of(state.progress.failure));
  out.u8(code_of(result.method));
  out.u8(taken_over ? 1 : 0);
  out.u8(0);
  for (const double value :
       {result.yaw_rad, result.yaw_std_rad, result.pitch_rad, result.pitch_std_rad, result.maximum_db,
        result.self_consistency, result.triples_median_rad, result.triples_std_rad, result.azimuth_inlier_ratio}) {
    out.f32(number_code(value));
  }
  out.u16(count_code(result.tilts_used));
  out.u16(count_code(tilts));
  out.u16(service::result::record::kBytes);
  out.zeros(6);
  for (const plate::TiltSummary& tilt : std::span(result.tilts).first(tilts)) {
    out.u16(tilt_code(tilt.tilt_rad));
    out.u16(count_code(tilt.scans));
    for (const double value :
         {tilt.mean_db, tilt.std_db, tilt.median_db, tilt.mean_azimuth_rad, tilt.azimuth_std_rad, tilt.fitted_db}) {
      out.f32(number_code(value));
    }
    out.u16(tilt.used ? service::result::kFlagUsed : std::uint16_t{0});
    out.u16(0);
  }
}

}  // namespace boresight::alignment::station
