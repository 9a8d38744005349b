// Health reports out by DDS: each radar on boresight/sensor_health, everything on rt/diagnostics.
#pragma once

#include <cstdint>

#include "interfaces/messages/health_report.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

class DiagnosticsWriter {
 public:
  /// Joins the domain; throws std::runtime_error if that is impossible.
  DiagnosticsWriter(const Config& config, const VehicleConfig& vehicle);
  /// Sends the whole report. `time_ns` is since the epoch. False if the middleware did not take all of it.
  bool write(const HealthReport& report, std::int64_t time_ns);

 private:
  VehicleConfig vehicle_;
  Participant participant_;
  eprosima::fastdds::dds::DataWriter& sensor_health_;
  eprosima::fastdds::dds::DataWriter& diagnostics_;
};

}  // namespace boresight::dds
