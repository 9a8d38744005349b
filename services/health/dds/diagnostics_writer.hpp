// Health reports out by DDS: each radar on boresight/sensor_health, the whole on boresight/system_health, everything on
// rt/diagnostics.
#pragma once

#include <cstdint>
#include <vector>

#include "generated/diagnostic_array.h"
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
  /// At the orderly end: readers see that radars and system ended, and rt/diagnostics is STALE. Waits until the readers
  /// have received this, but not longer than `at_most_s`.
  void end(std::int64_t time_ns, double at_most_s);

 private:
  VehicleConfig vehicle_;
  eprosima::fastdds::dds::DataWriter& sensor_health_;
  eprosima::fastdds::dds::DataWriter& system_health_;
  eprosima::fastdds::dds::DataWriter& diagnostics_;
  std::vector<std::uint32_t> sent_radars_;  ///< ids
  diagnostic_msgs::msg::dds_::DiagnosticArray_ sent_array_;
};

}  // namespace boresight::dds
