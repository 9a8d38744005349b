// Payloads of the calibration service ↔ values (interfaces/wire/calibration_service.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "interfaces/wire/calibration_service.hpp"
#include "services/alignment_estimator/core/plate/station.hpp"
#include "services/common/someip/byte_writer.hpp"

namespace boresight::alignment::station {

/// A station's request, not checked yet.
struct StartRequest {
  std::uint32_t radar_id = 0;
  plate::RunPlan plan;                 ///< number_of_tilts as requested; only the first kMaxTilts tilts are stored
  std::optional<std::uint8_t> method;  ///< as sent
  std::optional<float> min_amplitude_db;
};

struct MeasureRequest {
  std::size_t tilt_index = 0;
  std::optional<double> tilt_rad;  ///< nothing: exactly as requested
};

/// Nothing if the length or the layout version is wrong.
[[nodiscard]] std::optional<StartRequest> read_start(std::span<const std::uint8_t> payload);
[[nodiscard]] std::optional<MeasureRequest> read_measure(std::span<const std::uint8_t> payload);
/// Next and RepeatTilt: the tilt's index.
[[nodiscard]] std::optional<std::size_t> read_tilt(std::span<const std::uint8_t> payload);
/// RepeatRun and Abort: whether the payload is valid.
[[nodiscard]] bool read_run(std::span<const std::uint8_t> payload);

/// A run as the station sees it.
struct RunState {
  std::uint32_t run = 0;       ///< 0: none yet
  std::uint32_t radar_id = 0;  ///< 0: none yet
  std::uint16_t client = 0;    ///< client of the run; 0: none
  plate::Progress progress;
};

/// Largest payload of an answer.
inline constexpr std::size_t kMaxAnswerPayloadBytes =
    wire::calibration_service::result::kBytes + plate::kMaxTilts * wire::calibration_service::result::record::kBytes;

void write_state(const RunState& state, someip::ByteWriter& out);
void write_verdict(wire::calibration_service::Refusal refusal, const RunState& state, someip::ByteWriter& out);
/// `result` of the run; `state` contains its failure.
void write_result(const RunState& state, const plate::PlateResult& result, bool taken_over, someip::ByteWriter& out);

/// The refusals of the state machine are the first ones on the wire.
[[nodiscard]] wire::calibration_service::Refusal on_wire(plate::Refusal refusal);

}  // namespace boresight::alignment::station
