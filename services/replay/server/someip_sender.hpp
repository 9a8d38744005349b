// Sends recordings as events of the Boresight service: decodes them as the gateway does, and serves each radar as an
// instance of the service.
#pragma once

#include <array>
#include <memory>

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/replay/senders/sender.hpp"
#include "services/replay/server/someip_server.hpp"

namespace boresight::replay {

/// Sends the gateway's decoded scans and ego motions as events.
class EventSink : public ingest::Sink {
 public:
  explicit EventSink(SomeIpServer& server);

  /// Call before a frame: it was received at `received_ns` on the gateway's clock in the recording, and is sent now.
  void frame_begins(std::int64_t received_ns, std::int64_t due_ns);
  /// False if that frame completed a scan or an ego motion without a subscriber.
  [[nodiscard]] bool heard() const { return heard_; }

  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override;
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const ingest::MeasurementTime& time) override;
  void fault(Fault fault, std::string_view what, std::uint32_t radar_id) override;
  SourceStatistics& statistics(std::uint32_t radar_id) override;

 private:
  /// Time of measurement of the content on the clock of the events' stamps.
  [[nodiscard]] SensorTime stamp(const ingest::MeasurementTime& time) const;

  SomeIpServer& server_;
  std::unique_ptr<RadarScan> scan_;
  EgoMotion ego_{};
  std::array<SourceStatistics, kMaxRadars + 1> statistics_{};
  std::int64_t received_ns_ = 0;
  std::int64_t due_ns_ = 0;
  std::uint64_t faults_ = 0;
  bool heard_ = true;
};

class SomeIpSender : public Sender {
 public:
  SomeIpSender(const VehicleConfig& vehicle, SomeIpServer& server);

  /// False if the frame completed a scan or an ego motion without a subscriber.
  [[nodiscard]] bool send(const recording::Frame& frame) override;
  void wait_until(std::int64_t due_ns) override;
  void end_recording() override;

 private:
  SomeIpServer& server_;
  EventSink sink_;
  ingest::Gateway gateway_;
  ingest::RecordingClock clock_;
  std::int64_t due_ns_ = 0;
};

}  // namespace boresight::replay
