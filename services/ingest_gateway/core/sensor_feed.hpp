// Messages to the sensors: the vehicle's motion, and the configuration of their output.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/ars408_commands.hpp"
#include "services/ingest_gateway/codecs/ars548_motion.hpp"
#include "services/ingest_gateway/core/sink.hpp"

namespace boresight::ingest {

/// Only for radars with `ego_feed` or an output in the vehicle file.
class SensorFeed {
 public:
  explicit SensorFeed(const VehicleConfig& vehicle);

  /// Once, when the gateway starts: an ARS408 stores its configuration in memory with a limited number of writes.
  void start(Sink& sink) const;
  /// With each ego motion; sent at most at the sensors' rate.
  void send(const EgoMotion& ego, std::int64_t now_ns, Sink& sink);

 private:
  struct Ars548 {
    recording::Endpoint sensor;
    ars548::MotionFeed feed;
  };
  struct Ars408 {
    std::string interface;
    unsigned sensor_id;
    Ars408Output output;
    bool ego_feed;
  };
  static void send_can(const std::string& interface, const ars408::CommandFrame& command, Sink& sink);
  std::vector<Ars548> ars548_;
  std::vector<Ars408> ars408_;
  bool has_sent_ = false;
  std::int64_t last_can_ns_ = 0;
};

}  // namespace boresight::ingest
