#include "services/ingest_gateway/core/sensor_feed.hpp"

#include <cstdlib>

#include "interfaces/wire/ars548.hpp"

namespace boresight::ingest {

namespace {

// Two frames per sensor share the bus with its detections.
constexpr std::int64_t kCanPeriod_ns = 20'000'000;

}  // namespace

SensorFeed::SensorFeed(const VehicleConfig& vehicle) {
  for (const RadarConfig& radar : vehicle.radars) {
    if (radar.profile == RadarProfile::kArs548 && radar.ego_feed) {
      ars548_.push_back({{recording::ip_or_unspecified(radar.source.sender), wire::ars548::kSensorPort},
                         ars548::MotionFeed({.steering_ratio = radar.steering_ratio})});
    } else if (radar.profile == RadarProfile::kArs408) {
      ars408_.push_back({radar.source.interface, radar.sensor_id, radar.output, radar.ego_feed});
    }
  }
}

void SensorFeed::start(Sink& sink) const {
  for (const Ars408& radar : ars408_) {
    if (radar.output == Ars408Output::kAsItIs) continue;
    const auto output = radar.output == Ars408Output::kObjects ? ars408::Output::kObjects : ars408::Output::kClusters;
    send_can(radar.interface, ars408::configuration(output, radar.sensor_id), sink);
  }
}

void SensorFeed::send(const EgoMotion& ego, std::int64_t now_ns, Sink& sink) {
  for (Ars548& radar : ars548_) {
    for (const ars548::MotionDatagram& datagram : radar.feed.encode(ego, now_ns)) {
      recording::Frame frame;
      frame.kind = recording::FrameKind::kUdp;
      frame.destination = radar.sensor;
      frame.payload = datagram.payload();
      sink.send(frame);
    }
  }
  // Starts again if the clock went back.
  if (has_sent_ && std::abs(now_ns - last_can_ns_) < kCanPeriod_ns) return;
  has_sent_ = true;
  last_can_ns_ = now_ns;
  for (const Ars408& radar : ars408_) {
    if (!radar.ego_feed) continue;
    if (const auto speed = ars408::ego_speed(ego, radar.sensor_id)) send_can(radar.interface, *speed, sink);
    if (const auto yaw_rate = ars408::ego_yaw_rate(ego, radar.sensor_id)) send_can(radar.interface, *yaw_rate, sink);
  }
}

void SensorFeed::send_can(const std::string& interface, const ars408::CommandFrame& command, Sink& sink) {
  recording::Frame frame;
  frame.kind = recording::FrameKind::kCan;
  frame.set_interface(interface);
  frame.can_id = command.can_id;
  frame.payload = command.payload();
  sink.send(frame);
}

}  // namespace boresight::ingest
