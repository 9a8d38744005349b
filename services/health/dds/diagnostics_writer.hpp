// Health reports out by DDS: each radar on boresight/sensor_health, the whole on boresight/system_health, everything on
// rt/diagnostics.
#pragma once

#include <cstdint>

#include "interfaces/messages/health_report.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

class DiagnosticsWriter {
 public:
  /// Throws std::runtime_error if a topic or a writer cannot be created. `participant` must outlive this object.
  DiagnosticsWriter(Participant& participant, const VehicleConfig& vehicle);
  /// Sends the whole report. `time_ns` is since the epoch. False if the middleware did not take all of it.
  bool write(const HealthReport& report, std::int64_t time_ns);

 private:
  VehicleConfig vehicle_;
  eprosima::fastdds::dds::DataWriter& sensor_health_;
  eprosima::fastdds::dds::DataWriter& system_health_;
  eprosima::fastdds::dds::DataWriter& diagnostics_;
};

}  // namespace boresight::dds
