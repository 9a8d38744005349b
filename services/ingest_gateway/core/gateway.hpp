// Frames in, scans and ego motions out: finds the radar or signal set that a frame belongs to and feeds its codec.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/common/recording/frame.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/toyota_ego.hpp"
#include "services/ingest_gateway/codecs/toyota_radar.hpp"
#include "services/ingest_gateway/core/frame_stamp.hpp"

namespace boresight::ingest {

/// Where the gateway's products go: shared memory in the service, a vector in tests.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Memory for a scan, or nullptr if none can be had (which the sink counts); followed by publish_scan().
  virtual RadarScan* begin_scan() = 0;
  virtual void publish_scan(std::uint32_t radar_id, const MeasurementTime& time) = 0;
  /// The same for ego motion; always published.
  virtual EgoMotion* begin_ego() = 0;
  virtual void publish_ego(const MeasurementTime& time) = 0;
  /// Something was rejected; `radar_id` 0 if it cannot be told whose it was.
  virtual void fault(Fault fault, std::string_view what, std::uint32_t radar_id) = 0;
};

class Gateway {
 public:
  Gateway(const VehicleConfig& vehicle, Sink& sink);
  ~Gateway();

  /// Frames of unknown ids on a known CAN bus are ignored, as buses carry much else; datagrams from unknown senders
  /// to a radar's port are faults.
  void take(const recording::Frame& frame, const FrameStamp& stamp);

 private:
  struct CanRadar {
    std::uint32_t id;
    std::string interface;
    std::int64_t latency_ns;
    ToyotaRadar codec;
  };
  struct UdpRadar {
    std::uint32_t id;
    std::uint32_t destination_ipv4;
    std::uint32_t sender_ipv4;  // 0: any
    std::uint16_t port;
    std::int64_t latency_ns;
  };
  void take_can(const recording::Frame& frame, const FrameStamp& stamp);
  void take_udp(const recording::Frame& frame, const FrameStamp& stamp);
  void take_radar_frame(CanRadar& radar, const recording::Frame& frame, const FrameStamp& stamp);
  void finish_cycle(CanRadar& radar);
  void reject(DecodeResult result, std::string_view problem, std::uint32_t radar_id);

  Sink& sink_;
  std::string ego_interface_;
  ToyotaEgo ego_;
  std::vector<CanRadar> can_radars_;
  std::vector<UdpRadar> udp_radars_;
};

}  // namespace boresight::ingest
