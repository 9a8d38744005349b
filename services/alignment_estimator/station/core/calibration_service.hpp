// The calibration service without its sockets: requests of stations and scans in, answers and events out
// (interfaces/wire/calibration_service.md). It uses neither network nor clock, and never allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "interfaces/wire/calibration_service.hpp"
#include "services/alignment_estimator/core/plate/station.hpp"
#include "services/alignment_estimator/station/codecs/calibration_codec.hpp"
#include "services/common/recording/ip_address.hpp"
#include "services/common/someip/message.hpp"
#include "services/common/someip/session_counter.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::station {

/// Functions that the service needs from its surroundings.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// Sends an answer to the sender of the current request.
  virtual void answer(std::span<const std::uint8_t> message) = 0;
  /// A malformed request; a refused command is no fault.
  virtual void fault(Fault kind, std::string_view what) = 0;
  /// Passes a valid result; true if the dynamic estimator now starts from it.
  virtual bool take_over(std::uint32_t radar_id, const plate::PlateResult& result) = 0;
};

class CalibrationService {
 public:
  /// `max_speed_mps`: signalled speed up to which the vehicle counts as stationary.
  CalibrationService(const VehicleConfig& vehicle, const plate::StationConfig& config, double max_speed_mps);

  /// One datagram with one or several requests. Times are nanoseconds of one steady clock in all functions.
  void receive(std::span<const std::uint8_t> datagram, const recording::Endpoint& from, std::int64_t now_ns,
               Surroundings& surroundings);
  /// Every scan of every radar; those of the run's radar are used while a tilt is measured.
  void add_scan(const RadarScan& scan, std::int64_t now_ns);
  void add_ego_motion(const EgoMotion& motion, std::int64_t now_ns);
  /// Checks time-outs; call at least a few times per second.
  void tick(std::int64_t now_ns) { station_.tick(now_ns); }

  /// The event as a whole message if the state has changed since the last call, otherwise empty. Valid until the next
  /// call of another function.
  [[nodiscard]] std::span<const std::uint8_t> event_if_changed(std::int64_t now_ns);
  /// The event for a new subscriber.
  [[nodiscard]] std::span<const std::uint8_t> event(std::int64_t now_ns);
  [[nodiscard]] RunState state(std::int64_t now_ns) const;

 private:
  using Refusal = wire::calibration_service::Refusal;
  using ReturnCode = wire::calibration_service::ReturnCode;
  using Method = wire::calibration_service::Method;
  static constexpr std::size_t kMaxAnswerBytes = someip::kHeaderBytes + kMaxAnswerPayloadBytes;
  static constexpr std::size_t kMaxRequestPayloadBytes = 1400;
  static constexpr std::int64_t kNeverHeard = -1;

  /// The station that a run belongs to.
  struct Client {
    recording::IpAddress address;
    std::uint16_t id = 0;
    friend constexpr bool operator==(const Client&, const Client&) = default;
  };
  /// The last executed command. Its repetition after a lost answer gets the same answer.
  struct Obeyed {
    recording::Endpoint from;
    std::uint16_t client = 0, session = 0, method = 0;
    std::int64_t time_ns = 0;
    std::size_t payload_bytes = 0, answer_bytes = 0;
    std::array<std::uint8_t, kMaxRequestPayloadBytes> payload{};
    std::array<std::uint8_t, kMaxAnswerBytes> answer{};
  };
  /// Values whose change causes an event.
  struct Signature {
    std::uint32_t run = 0;
    plate::State state = plate::State::kIdle;
    plate::Failure failure = plate::Failure::kNone;
    std::size_t tilt_index = 0;
    friend constexpr bool operator==(const Signature&, const Signature&) = default;
  };
  /// The current request.
  struct Request {
    const someip::Message& message;
    const recording::Endpoint& from;
    std::int64_t now_ns;
    Surroundings& surroundings;
  };

  void take(const Request& request, someip::ReadResult read);
  [[nodiscard]] ReturnCode judge_header(const someip::Message& message, someip::ReadResult read) const;
  /// Executes the method; writes the payload of the answer if the result is kOk.
  [[nodiscard]] ReturnCode serve(const Request& request, someip::ByteWriter& out);
  [[nodiscard]] ReturnCode command(const Request& request, someip::ByteWriter& out);
  [[nodiscard]] Refusal start(const StartRequest& wanted, const Request& request);
  [[nodiscard]] Refusal measure(const MeasureRequest& wanted, const Request& request);
  [[nodiscard]] Refusal next(std::size_t tilt_index, const Request& request);
  [[nodiscard]] Refusal repeat_tilt(std::size_t tilt_index, const Request& request);
  [[nodiscard]] Refusal repeat_run(const Request& request);
  [[nodiscard]] Refusal abort(const Request& request);
  /// Begins a new run of this client.
  void begin_run(std::uint32_t radar_id, const Request& request);

  [[nodiscard]] bool is_running() const;
  [[nodiscard]] bool is_busy_with_another(const Request& request) const;
  [[nodiscard]] bool vehicle_moves(std::int64_t now_ns) const;
  [[nodiscard]] bool is_repetition(const Request& request) const;
  void answer(const Request& request, ReturnCode code, std::size_t payload_bytes);
  [[nodiscard]] static Client client_of(const Request& request);

  std::array<bool, kMaxRadars + 1> known_radars_{};
  plate::StationConfig config_;
  double max_speed_mps_;
  plate::PlateStation station_;
  std::uint32_t run_ = 0;
  std::uint32_t radar_id_ = 0;
  Client owner_;
  bool taken_over_ = false;
  double speed_mps_ = 0.0;
  std::int64_t speed_time_ns_ = kNeverHeard;
  Signature reported_;
  someip::SessionCounter event_session_;
  Obeyed obeyed_;
  std::array<std::uint8_t, kMaxAnswerBytes> answer_{};
  std::array<std::uint8_t, someip::kHeaderBytes + wire::calibration_service::state::kBytes> event_{};
};

}  // namespace boresight::alignment::station
