// Receiver of the gateway's output: shared memory in the service, a vector in tests, a table in the decode tool.
#pragma once

#include <cstdint>
#include <string_view>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/common/recording/frame.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"

namespace boresight::ingest {

class Sink {
 public:
  virtual ~Sink() = default;
  /// Memory for a scan, or nullptr if none is available, which the sink counts. Followed by publish_scan() or
  /// discard_scan().
  virtual RadarScan* begin_scan() = 0;
  virtual void publish_scan(std::uint32_t radar_id, const MeasurementTime& time) = 0;
  virtual void discard_scan() = 0;
  /// The same for ego motion; always published.
  virtual EgoMotion* begin_ego() = 0;
  virtual void publish_ego(const MeasurementTime& time) = 0;
  /// Reports a rejected input; `radar_id` is 0 for the vehicle, or if the radar is unknown.
  virtual void fault(Fault fault, std::string_view what, std::uint32_t radar_id) = 0;
  /// Statistics of one radar, created at first use. The gateway counts all fields except `messages`, which
  /// publish_scan() counts, and `rejected`, which fault() counts.
  virtual SourceStatistics& statistics(std::uint32_t radar_id) = 0;

  /// A frame for a sensor or another stack: sent by the link of its interface (CAN) or from its source endpoint (UDP).
  /// Does nothing without links, as with recordings.
  virtual void send(const recording::Frame& /*frame*/) {}
  /// Multicast groups that peers announce; `interface` as in the vehicle file.
  virtual void join(const recording::Endpoint& /*group*/, std::string_view /*interface*/) {}
  virtual void leave(const recording::Endpoint& /*group*/, std::string_view /*interface*/) {}
};

}  // namespace boresight::ingest
