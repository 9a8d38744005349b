#include "services/health/dds/diagnostics_writer.hpp"

#include <algorithm>

#include <fastdds/dds/publisher/DataWriter.hpp>

#include "generated/diagnostic_arrayPubSubTypes.h"
#include "generated/sensor_healthPubSubTypes.h"
#include "generated/system_healthPubSubTypes.h"
#include "services/health/dds/guarded_type.hpp"
#include "services/health/dds/system_health.hpp"
#include "services/health/dds/to_dds.hpp"

namespace boresight::dds {

DiagnosticsWriter::DiagnosticsWriter(Participant& participant, const VehicleConfig& vehicle)
    : vehicle_(vehicle),
      sensor_health_(participant.writer(kSensorHealthTopic, guarded<diagnostics::SensorHealthPubSubType>())),
      system_health_(participant.writer(kSystemHealthTopic, guarded<diagnostics::SystemHealthPubSubType>())),
      diagnostics_(
          participant.writer(kDiagnosticsTopic, guarded<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>())) {}

bool DiagnosticsWriter::write(const HealthReport& report, std::int64_t time_ns) {
  bool taken = true;
  const std::size_t sensors = std::min<std::size_t>(report.number_of_sensors, kMaxRadars);
  for (std::size_t i = 0; i < sensors; ++i) {
    diagnostics::SensorHealth sample = to_sensor_health(report, i, vehicle_, time_ns);
    taken = sensor_health_.write(&sample) && taken;
  }
  diagnostics::SystemHealth system = to_system_health(report, vehicle_, time_ns);
  taken = system_health_.write(&system) && taken;
  auto array = to_diagnostic_array(report, vehicle_, time_ns);
  return diagnostics_.write(&array) && taken;
}

}  // namespace boresight::dds
