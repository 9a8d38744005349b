#include "services/alignment_estimator/station/core/calibration_service.hpp"

#include <algorithm>
#include <cmath>

#include "services/common/someip/byte_writer.hpp"

namespace boresight::alignment::station {

namespace service = wire::calibration_service;

namespace {

/// An older speed signal is not used.
constexpr std::int64_t kSpeedIsOld_ns = 1'000'000'000;
constexpr auto kRepetition_ns = static_cast<std::int64_t>(service::kRepetition_s * 1e9);

bool is_request(someip::MessageType type) {
  return type == someip::MessageType::kRequest || type == someip::MessageType::kRequestNoReturn;
}

Fault kind_of(service::ReturnCode code) {
  switch (code) {
    case service::ReturnCode::kUnknownService:
    case service::ReturnCode::kUnknownMethod:
      return Fault::kWireUnknown;
    case service::ReturnCode::kMalformedMessage:
      return Fault::kWireLength;
    default:
      return Fault::kWireValue;
  }
}

std::string_view describe(service::ReturnCode code) {
  switch (code) {
    case service::ReturnCode::kUnknownService:
      return "calibration request: unknown service";
    case service::ReturnCode::kUnknownMethod:
      return "calibration request: unknown method";
    case service::ReturnCode::kWrongProtocolVersion:
      return "calibration request: protocol version is not 1";
    case service::ReturnCode::kWrongInterfaceVersion:
      return "calibration request: interface version is not 1";
    case service::ReturnCode::kMalformedMessage:
      return "calibration request: wrong payload length or layout version for its method";
    case service::ReturnCode::kWrongMessageType:
      return "calibration request: segmented, or with a return code";
    default:
      return "calibration request";
  }
}

}  // namespace

CalibrationService::CalibrationService(const VehicleConfig& vehicle, const plate::StationConfig& config,
                                       double max_speed_mps)
    : config_(config), max_speed_mps_(max_speed_mps), station_(config) {
  for (const RadarConfig& radar : vehicle.radars) {
    if (radar.id < known_radars_.size()) known_radars_[radar.id] = true;
  }
}

void CalibrationService::receive(std::span<const std::uint8_t> datagram, const recording::Endpoint& from,
                                 std::int64_t now_ns, Surroundings& surroundings) {
  someip::MessageReader reader(datagram);
  someip::Message message;
  while (true) {
    const someip::ReadResult read = reader.next(message);
    switch (read) {
      case someip::ReadResult::kEnd:
        return;
      case someip::ReadResult::kHeaderCut:
      case someip::ReadResult::kLengthTooSmall:
      case someip::ReadResult::kBeyondDatagram:
        surroundings.fault(Fault::kWireLength, someip::describe(read));
        break;
      case someip::ReadResult::kMessageType:
        surroundings.fault(Fault::kWireValue, someip::describe(read));
        break;
      case someip::ReadResult::kProtocolVersion:
      case someip::ReadResult::kMessage:
        take({message, from, now_ns, surroundings}, read);
        break;
    }
  }
}

service::ReturnCode CalibrationService::judge_header(const someip::Message& message, someip::ReadResult read) const {
  if (read == someip::ReadResult::kProtocolVersion) return ReturnCode::kWrongProtocolVersion;
  if (message.tp || message.return_code != 0) return ReturnCode::kWrongMessageType;
  if (message.service != service::kServiceId) return ReturnCode::kUnknownService;
  if (message.interface_version != service::kMajorVersion) return ReturnCode::kWrongInterfaceVersion;
  return ReturnCode::kOk;
}

void CalibrationService::take(const Request& request, someip::ReadResult read) {
  if (!is_request(request.message.type)) {
    // An answer to an answer could cause an endless exchange.
    request.surroundings.fault(Fault::kWireValue, "calibration request: not a request");
    return;
  }
  station_.tick(request.now_ns);
  ReturnCode code = judge_header(request.message, read);
  if (code == ReturnCode::kOk && is_repetition(request)) {
    if (request.message.type == someip::MessageType::kRequest) {
      request.surroundings.answer(std::span<const std::uint8_t>(obeyed_.answer).first(obeyed_.answer_bytes));
    }
    return;
  }
  someip::ByteWriter payload(std::span<std::uint8_t>(answer_).subspan(someip::kHeaderBytes));
  if (code == ReturnCode::kOk) code = serve(request, payload);
  if (code != ReturnCode::kOk && code != ReturnCode::kNotReady) {
    request.surroundings.fault(kind_of(code), describe(code));
  }
  answer(request, code, code == ReturnCode::kOk ? payload.size() : 0);
}

void CalibrationService::answer(const Request& request, ReturnCode code, std::size_t payload_bytes) {
  someip::Message header = request.message;
  header.type = code == ReturnCode::kOk ? someip::MessageType::kResponse : someip::MessageType::kError;
  header.tp = false;
  header.protocol_version = someip::kProtocolVersion;
  header.interface_version = service::kMajorVersion;
  header.return_code = static_cast<std::uint8_t>(code);
  someip::write_header(header, payload_bytes, std::span<std::uint8_t>(answer_).first<someip::kHeaderBytes>());
  const auto message = std::span<const std::uint8_t>(answer_).first(someip::kHeaderBytes + payload_bytes);
  if (obeyed_.answer_bytes == 0) {
    // The command of this request has just been executed.
    std::copy(message.begin(), message.end(), obeyed_.answer.begin());
    obeyed_.answer_bytes = message.size();
  }
  if (request.message.type == someip::MessageType::kRequest) request.surroundings.answer(message);
}

bool CalibrationService::is_repetition(const Request& request) const {
  const someip::Message& message = request.message;
  return message.session != 0 && message.session == obeyed_.session && message.client == obeyed_.client &&
         message.method == obeyed_.method && request.from == obeyed_.from &&
         request.now_ns - obeyed_.time_ns <= kRepetition_ns &&
         std::equal(message.payload.begin(), message.payload.end(), obeyed_.payload.begin(),
                    obeyed_.payload.begin() + static_cast<std::ptrdiff_t>(obeyed_.payload_bytes));
}

service::ReturnCode CalibrationService::serve(const Request& request, someip::ByteWriter& out) {
  const someip::Message& message = request.message;
  switch (static_cast<Method>(message.method)) {
    case Method::kStartCalibration:
    case Method::kMeasure:
    case Method::kNext:
    case Method::kRepeatTilt:
    case Method::kRepeatRun:
    case Method::kAbort:
      return command(request, out);
    case Method::kGetState:
      if (!message.payload.empty()) return ReturnCode::kMalformedMessage;
      write_state(state(request.now_ns), out);
      return ReturnCode::kOk;
    case Method::kGetResult: {
      if (!message.payload.empty()) return ReturnCode::kMalformedMessage;
      const RunState now = state(request.now_ns);
      const bool is_over = now.progress.state == plate::State::kFinished || now.progress.state == plate::State::kFailed;
      if (!is_over) return ReturnCode::kNotReady;
      write_result(now, station_.result(), taken_over_, out);
      return ReturnCode::kOk;
    }
  }
  return ReturnCode::kUnknownMethod;
}

service::ReturnCode CalibrationService::command(const Request& request, someip::ByteWriter& out) {
  const someip::Message& message = request.message;
  const std::span<const std::uint8_t> payload = message.payload;
  if (payload.size() > kMaxRequestPayloadBytes) return ReturnCode::kMalformedMessage;
  Refusal refusal = Refusal::kNone;
  switch (static_cast<Method>(message.method)) {
    case Method::kStartCalibration: {
      const auto wanted = read_start(payload);
      if (!wanted) return ReturnCode::kMalformedMessage;
      refusal = start(*wanted, request);
      break;
    }
    case Method::kMeasure: {
      const auto wanted = read_measure(payload);
      if (!wanted) return ReturnCode::kMalformedMessage;
      refusal = measure(*wanted, request);
      break;
    }
    case Method::kNext:
    case Method::kRepeatTilt: {
      const auto tilt_index = read_tilt(payload);
      if (!tilt_index) return ReturnCode::kMalformedMessage;
      const bool is_next = static_cast<Method>(message.method) == Method::kNext;
      refusal = is_next ? next(*tilt_index, request) : repeat_tilt(*tilt_index, request);
      break;
    }
    default: {
      if (!read_run(payload)) return ReturnCode::kMalformedMessage;
      const bool is_repeat = static_cast<Method>(message.method) == Method::kRepeatRun;
      refusal = is_repeat ? repeat_run(request) : abort(request);
      break;
    }
  }
  write_verdict(refusal, state(request.now_ns), out);
  if (refusal == Refusal::kNone) {
    obeyed_.from = request.from;
    obeyed_.client = message.client;
    obeyed_.session = message.session;
    obeyed_.method = message.method;
    obeyed_.time_ns = request.now_ns;
    obeyed_.payload_bytes = payload.size();
    std::copy(payload.begin(), payload.end(), obeyed_.payload.begin());
    obeyed_.answer_bytes = 0;
  }
  return ReturnCode::kOk;
}

service::Refusal CalibrationService::start(const StartRequest& wanted, const Request& request) {
  if (is_busy_with_another(request)) return Refusal::kBusy;
  if (is_running()) return Refusal::kWrongState;
  if (wanted.radar_id >= known_radars_.size() || !known_radars_[wanted.radar_id]) return Refusal::kUnknownRadar;
  if (vehicle_moves(request.now_ns)) return Refusal::kVehicleMoves;
  plate::StationConfig config = config_;
  if (wanted.method) {
    if (*wanted.method > service::start::kMethodPublished) return Refusal::kLimitOutOfRange;
    config.fit.method = static_cast<plate::FitMethod>(*wanted.method);
  }
  if (wanted.min_amplitude_db) {
    if (!std::isfinite(*wanted.min_amplitude_db)) return Refusal::kLimitOutOfRange;
    config.fit.min_amplitude_db = *wanted.min_amplitude_db;
  }
  // The limits are those of this run. A refused request keeps the result of the previous run.
  plate::PlateStation candidate(config);
  const plate::Refusal refusal = candidate.start(wanted.plan, request.now_ns);
  if (refusal != plate::Refusal::kNone) return on_wire(refusal);
  station_ = candidate;
  begin_run(wanted.radar_id, request);
  return Refusal::kNone;
}

service::Refusal CalibrationService::repeat_run(const Request& request) {
  if (is_busy_with_another(request)) return Refusal::kBusy;
  if (vehicle_moves(request.now_ns)) return Refusal::kVehicleMoves;
  const plate::Refusal refusal = station_.repeat_run(request.now_ns);
  if (refusal == plate::Refusal::kNone) begin_run(radar_id_, request);
  return on_wire(refusal);
}

void CalibrationService::begin_run(std::uint32_t radar_id, const Request& request) {
  ++run_;
  radar_id_ = radar_id;
  owner_ = client_of(request);
  taken_over_ = false;
}

service::Refusal CalibrationService::measure(const MeasureRequest& wanted, const Request& request) {
  if (is_busy_with_another(request)) return Refusal::kBusy;
  if (station_.state() != plate::State::kPositioning) return Refusal::kWrongState;
  const plate::Progress progress = station_.progress(request.now_ns);
  if (wanted.tilt_index != progress.tilt_index) return Refusal::kWrongTiltIndex;
  return on_wire(station_.measure(wanted.tilt_rad.value_or(progress.tilt_rad), request.now_ns));
}

service::Refusal CalibrationService::next(std::size_t tilt_index, const Request& request) {
  if (is_busy_with_another(request)) return Refusal::kBusy;
  if (station_.state() != plate::State::kTiltDone) return Refusal::kWrongState;
  if (tilt_index != station_.progress(request.now_ns).tilt_index) return Refusal::kWrongTiltIndex;
  const plate::Refusal refusal = station_.next(request.now_ns);
  if (station_.state() == plate::State::kFinished) {
    taken_over_ = request.surroundings.take_over(radar_id_, station_.result());
  }
  return on_wire(refusal);
}

service::Refusal CalibrationService::repeat_tilt(std::size_t tilt_index, const Request& request) {
  if (is_busy_with_another(request)) return Refusal::kBusy;
  if (!is_running()) return Refusal::kWrongState;
  if (tilt_index != station_.progress(request.now_ns).tilt_index) return Refusal::kWrongTiltIndex;
  return on_wire(station_.repeat_tilt(request.now_ns));
}

service::Refusal CalibrationService::abort(const Request& request) {
  if (is_busy_with_another(request)) return Refusal::kBusy;
  return on_wire(station_.abort(request.now_ns));
}

void CalibrationService::add_scan(const RadarScan& scan, std::int64_t now_ns) {
  if (station_.state() != plate::State::kMeasuring || scan.header.source_id != radar_id_) return;
  station_.add_scan(scan, now_ns);
}

void CalibrationService::add_ego_motion(const EgoMotion& motion, std::int64_t now_ns) {
  if (!motion.has(ego_field::kSpeed)) return;
  speed_mps_ = motion.speed_mps;
  speed_time_ns_ = now_ns;
}

bool CalibrationService::is_running() const {
  const plate::State state = station_.state();
  return state == plate::State::kPositioning || state == plate::State::kMeasuring || state == plate::State::kTiltDone;
}

bool CalibrationService::is_busy_with_another(const Request& request) const {
  return is_running() && client_of(request) != owner_;
}

bool CalibrationService::vehicle_moves(std::int64_t now_ns) const {
  if (speed_time_ns_ == kNeverHeard || now_ns - speed_time_ns_ > kSpeedIsOld_ns) return false;
  return !(std::abs(speed_mps_) <= max_speed_mps_);
}

CalibrationService::Client CalibrationService::client_of(const Request& request) {
  return {request.from.address, request.message.client};
}

RunState CalibrationService::state(std::int64_t now_ns) const {
  return {run_, radar_id_, is_running() ? owner_.id : std::uint16_t{0}, station_.progress(now_ns)};
}

std::span<const std::uint8_t> CalibrationService::event_if_changed(std::int64_t now_ns) {
  const plate::Progress progress = station_.progress(now_ns);
  const Signature now{run_, progress.state, progress.failure, progress.tilt_index};
  if (now == reported_) return {};
  reported_ = now;
  return event(now_ns);
}

std::span<const std::uint8_t> CalibrationService::event(std::int64_t now_ns) {
  someip::Message header;
  header.service = service::kServiceId;
  header.method = service::kEventState;
  header.session = event_session_.take();
  header.protocol_version = someip::kProtocolVersion;
  header.interface_version = service::kMajorVersion;
  header.type = someip::MessageType::kNotification;
  someip::write_header(header, service::state::kBytes, std::span<std::uint8_t>(event_).first<someip::kHeaderBytes>());
  someip::ByteWriter payload(std::span<std::uint8_t>(event_).subspan(someip::kHeaderBytes));
  write_state(state(now_ns), payload);
  return event_;
}

}  // namespace boresight::alignment::station
