// From frames to scans and ego motions: finds the source of a frame and passes the frame to its decoder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/common/recording/frame.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"
#include "services/ingest_gateway/core/discovery.hpp"
#include "services/ingest_gateway/core/ego_assembler.hpp"
#include "services/ingest_gateway/core/mappings.hpp"
#include "services/ingest_gateway/core/sensor_feed.hpp"
#include "services/ingest_gateway/core/sink.hpp"
#include "services/ingest_gateway/core/someip_receiver.hpp"
#include "services/ingest_gateway/core/source.hpp"

namespace boresight::ingest {

class Gateway : private EgoReceiver {
 public:
  /// Throws std::invalid_argument if the vehicle names a mapping that `mappings` lacks.
  Gateway(const VehicleConfig& vehicle, Sink& sink, const Mappings& mappings = {},
          const ContradictionConfig& contradiction = {});
  ~Gateway() override;

  /// Frames with unknown ids on a known CAN bus are ignored, as buses carry other traffic. Datagrams from unknown
  /// senders to a radar's port are faults.
  void take(const recording::Frame& frame, const FrameStamp& stamp);
  /// Advances the time, so that incomplete cycles end. With live input, call about every 5 ms while no old frames wait:
  /// links do not deliver their frames in the order of stamps. With a recording, take() advances the time by the stamps
  /// of the frames, so that the result does not depend on the speed of the replay.
  void tick(std::int64_t now_ns);
  /// Searches the services of the vehicle file and configures sensors. With a recording, take() does this, and nothing
  /// is sent.
  void start(std::int64_t now_ns);
  /// Ends subscriptions.
  void stop();
  /// An interface or address of live input is back: searches missing services.
  void network_is_up(std::int64_t now_ns);
  /// End of input: ends incomplete cycles and messages.
  void finish();

 private:
  struct CanRoute {
    std::string interface;  // "": any
    Source* source;
  };
  struct UdpRoute {
    recording::Endpoint destination;  // unspecified: any
    recording::IpAddress sender;      // unspecified: any
    Source* source;
  };
  void tick_sources(std::int64_t now_ns);
  void take_can(const recording::Frame& frame, const FrameStamp& stamp);
  void take_udp(const recording::Frame& frame, const FrameStamp& stamp);
  [[nodiscard]] bool is_for_someip(const recording::Frame& frame) const;
  void add_radar(const RadarConfig& radar, const Mappings& mappings, const ContradictionConfig& contradiction);
  void add_someip(Source& source, const SourceAddress& address, std::uint16_t event, std::uint16_t eventgroup,
                  const E2eConfig& e2e);
  void take_ego(std::uint32_t source_id, const EgoReading& reading, const FrameStamp& reception) override;
  [[nodiscard]] const EgoMotion* latest_ego(std::int64_t time_ns) const override;

  Sink& sink_;
  std::int64_t last_tick_ns_ = 0;
  EgoAssembler ego_;
  Source ego_source_;
  std::uint32_t ego_source_id_ = 0;  // source of the used ego readings
  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<CanRoute> can_;
  std::vector<UdpRoute> udp_;
  SomeIpReceiver someip_;
  std::vector<std::unique_ptr<Discovery>> discoveries_;
  std::vector<std::uint16_t> someip_ports_;  // at which events arrive
  bool started_ = false;
  bool stamps_tell_time_ = false;  // start() was not called: a recording
  SensorFeed feed_;
  EgoMotion latest_ego_{};
  bool has_ego_ = false;
};

}  // namespace boresight::ingest
